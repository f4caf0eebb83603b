"""Functions in Python as estimators of a study."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Optional, Union

import numpy as np

from ._arrays import Floats

#: What a function gives: estimates in the order of ``parameters``, the same with their standard errors, or either by name.
Estimated = Any

#: One experiment as the program states it: name, levels, satellite, lead, input.
_Experiment = tuple[str, bytes, float, int, bytes]

#: The same with arrays.
_Known = tuple[str, Floats, float, int, Floats]

#: Order, points, samples, interval, parameters, and both experiments.
_Design = tuple[int, int, int, tuple[float, float], list[str], _Known, _Known]


@dataclass
class MethodExperiment:
    """A pulse experiment, as an estimator sees it. Arrays cannot be changed."""

    name: str
    """``descendant`` or ``ascendant``."""
    levels: Floats
    """V₁ … V_m, input units."""
    satellite: float
    """Where the input rests between visits."""
    lead: int
    """Samples before t = 0, which serve as lags only."""
    v: Floats
    """Input, shape (lead + N,)."""
    y: Floats
    """Output, shape (lead + N,)."""


@dataclass
class MethodRecords:
    """Both experiments of one replicate, as an estimator sees them: nothing of the system is in it."""

    cell: int
    """Place of the cell in the results."""
    order: int
    """The order n to assume."""
    points: int
    """Points m on each border."""
    samples: int
    """N."""
    interval: tuple[float, float]
    """Where the input may go."""
    parameters: list[str]
    """What is to be estimated."""
    replicate: int
    """Number of the replicate."""
    antithetic: bool
    """Whether its noise has the other sign."""
    descendant: MethodExperiment
    """The descendant experiment."""
    ascendant: MethodExperiment
    """The ascendant experiment."""


class Adaptor:
    """A function behind the interface of the native part."""

    def __init__(self, function: Callable[[MethodRecords], Estimated]) -> None:
        self._function = function
        self._designs: dict[int, _Design] = {}

    def design(
        self,
        cell: int,
        order: int,
        points: int,
        samples: int,
        interval: tuple[float, float],
        parameters: list[str],
        experiments: tuple[_Experiment, _Experiment],
    ) -> None:
        def known(of: _Experiment) -> _Known:
            name, levels, satellite, lead, v = of
            return name, _array(levels), satellite, lead, _array(v)

        self._designs[cell] = (order, points, samples, interval, parameters, known(experiments[0]), known(experiments[1]))

    def __call__(
        self, cell: int, replicate: int, antithetic: bool, first: bytes, second: bytes
    ) -> tuple[Optional[bytes], Optional[bytes], Optional[str]]:
        order, points, samples, interval, parameters, down, up = self._designs[cell]
        descendant = MethodExperiment(down[0], down[1], down[2], down[3], down[4], _array(first))
        ascendant = MethodExperiment(up[0], up[1], up[2], up[3], up[4], _array(second))
        records = MethodRecords(
            cell, order, points, samples, interval, parameters, replicate, antithetic, descendant, ascendant
        )
        try:
            found, se = _parts(self._function(records), records.parameters)
            return _bytes(found), None if se is None else _bytes(se), None
        except Exception as error:
            return None, None, f"{type(error).__name__}: {error}"


def _array(data: bytes) -> Floats:
    """The numbers in some bytes, without a copy."""
    return np.frombuffer(data, dtype=np.float64)


def _bytes(values: Any) -> bytes:
    return np.ascontiguousarray(values, dtype=np.float64).ravel().tobytes()


def _parts(found: Estimated, names: Sequence[str]) -> tuple[Any, Any]:
    """Estimates, and standard errors where there are any."""
    is_pair = isinstance(found, tuple) and len(found) == 2 and (isinstance(found[0], Mapping) or np.ndim(found[0]) == 1)
    values, se = found if is_pair else (found, None)
    return _by_name(values, names), None if se is None else _by_name(se, names)


def _by_name(values: Any, names: Sequence[str]) -> Any:
    return [values[name] for name in names] if isinstance(values, Mapping) else values


Methods = Mapping[str, Callable[[MethodRecords], Estimated]]


def adaptors(methods: Optional[Methods]) -> list[tuple[str, Union[Adaptor, Any]]]:
    """Functions by their names, as the native part takes them."""
    return [(name, Adaptor(function)) for name, function in (methods or {}).items()]
