"""Consistency studies: do the estimates converge to the truth, how fast, with which error bars."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Optional, Union

from . import _native
from ._methods import Methods, adaptors
from ._native import SwitchbackError
from ._progress import shown
from ._result import PathLike, Result
from ._table import Estimate, Row, Table
from ._options import texts

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True)
class Expectation(Row):
    """Something that the scenario expects, and whether it came out."""

    what: str
    held: bool
    detail: str


@dataclass(frozen=True)
class Summary(Row):
    """What one group of parameters of one method does as the records grow; intervals are 95 %."""

    case: str
    border: str
    method: str
    points: int
    noise: float
    #: ``a``, ``b``, ``descending`` or ``ascending``.
    group: str
    #: ``consistent``, ``inconsistent`` or ``undecided``.
    verdict: str
    reason: str
    #: Slope of the standard deviation over N, both logarithmic: −½ where it falls as it should.
    sd_slope: Estimate
    #: Slope of the bias, where it is resolved: −1 where it falls as 1/N.
    bias_slope: Estimate

    @classmethod
    def of(cls, found: Mapping[str, Any]) -> Summary:
        """That of an object in the program's JSON."""
        slopes = {name: Estimate.of(found.get(name), interval="ci") for name in ("sd_slope", "bias_slope")}
        return super().of({**found["series"], **found, **slopes})


@dataclass(frozen=True)
class Cell(Row):
    """One parameter at one length of the records: what its estimates do over the replicates."""

    case: str
    border: str
    method: str
    points: int
    noise: float
    samples: int
    name: str
    group: str
    #: Where on the border, input units.
    v: Optional[float]
    truth: Optional[float]
    #: Each with its Monte-Carlo standard error.
    bias: Optional[float]
    bias_error: Optional[float]
    sd: Optional[float]
    sd_error: Optional[float]
    #: Share of the 95 % intervals that hold the truth.
    coverage: Optional[float]
    coverage_error: Optional[float]
    #: Standard deviation by theory.
    theory_sd: Optional[float]
    #: The Cramér–Rao bound, as a standard deviation.
    bound_sd: Optional[float]


class Study(Result):
    """The results of a consistency study."""

    def __init__(self, answer: _native.Answer, scenario: Optional[str] = None) -> None:
        super().__init__(answer)
        self._scenario = scenario

    def __getstate__(self) -> dict[str, Any]:
        return {"_answer": self._answer, "_scenario": self._scenario}

    @property
    def name(self) -> str:
        """The study's name."""
        return str(self._data["name"])

    @property
    def question(self) -> str:
        """The question it answers."""
        return str(self._data["question"])

    @property
    def scenario(self) -> Optional[str]:
        """The scenario as TOML where it was a mapping: in a file the command line runs it as it was run here."""
        return self._scenario

    @cached_property
    def expectations(self) -> Table[Expectation]:
        """What the scenario expects, and whether it came out."""
        return Table(Expectation.of(one) for one in self._data["expectations"])

    @property
    def as_expected(self) -> bool:
        """Whether all of it came out; where not, the command line exits with 1."""
        return all(one.held for one in self.expectations)

    @cached_property
    def summaries(self) -> Table[Summary]:
        """What each group of parameters does as the records grow."""
        return Table(Summary.of(one) for one in self._data["summaries"])

    @cached_property
    def cells(self) -> Table[Cell]:
        """Every parameter at every length."""
        return Table(
            Cell.of({**cell["series"], **parameter, **_with_errors(parameter), "samples": cell["samples"]})
            for cell in self._data["cells"]
            for parameter in cell["parameters"]
        )

    def plot(self, group: str = "a", ax: Optional[Axes] = None) -> Axes:
        """Bias (solid) and standard deviation (dashed) of a group of parameters over the number of samples, one colour a method; needs
        matplotlib. Returns the axes."""
        from . import _plots

        cells = [cell for cell in self.cells if cell.group == group and cell.bias is not None and cell.sd is not None]
        if not cells:
            groups = ", ".join(dict.fromkeys(cell.group for cell in self.cells))
            raise SwitchbackError(f"there is no group `{group}`; the groups are {groups}")
        return _plots.consistency(cells, group, ax)

    def __repr__(self) -> str:
        kept = "as expected" if self.as_expected else "not as expected"
        return f"Study({self.name!r}, {len(self.summaries)} rows, {kept})"


def study(
    scenario: Union[PathLike, Mapping[str, Any]],
    *,
    name: str = "scenario",
    engine: Optional[str] = None,
    threads: Optional[int] = None,
    yes: bool = False,
    progress: Optional[bool] = None,
    methods: Optional[Methods] = None,
) -> Study:
    """Runs a consistency study: Monte-Carlo replicates of every cell of a sweep, and what they amount to.

    Nothing is written; :meth:`Study.save` writes the report.

    Parameters
    ----------
    scenario
        A scenario file, or the same as a mapping of keys to numbers, texts, lists and mappings.
    name
        Name of the study where it is a mapping.
    engine
        ``superposed`` or ``direct``, whatever the scenario says.
    threads, progress
        As in :func:`identify`.
    yes
        Run it even if it is estimated to take longer than a day.
    methods
        Estimators of your own by their names: functions of :class:`MethodRecords` that give the estimates in the order of ``parameters`` (or by
        name), or a pair of estimates and standard errors. Each is judged beside the methods of the scenario, on the same noise. What a function
        raises is a failure of that replicate. It is called from several threads, one after the other.

    Raises
    ------
    SwitchbackError
        In the words of the command line; for a mapping, places are those of its TOML.
    """
    options = texts(engine=engine, threads=threads, yes=yes)
    with shown(progress) as heard:
        if isinstance(scenario, Mapping):
            text = _json_of(scenario)
            answer, toml = _native.study_of_json(f"{name}.toml", text, options, heard, adaptors(methods))
            return Study(answer, toml)
        return Study(_native.study(os.fspath(scenario), options, heard, adaptors(methods)))


def _json_of(scenario: Mapping[str, Any]) -> str:
    def plain(value: Any) -> Any:
        if hasattr(value, "tolist"):  # NumPy
            return value.tolist()
        if isinstance(value, Mapping):
            return dict(value)
        raise TypeError(f"{type(value).__name__}")

    try:
        return json.dumps(_without_none(scenario), default=plain, allow_nan=False)
    except TypeError as error:
        raise SwitchbackError(f"a scenario holds numbers, texts, lists and mappings, and no {error}") from None
    except ValueError:
        raise SwitchbackError("the scenario holds a number that is not finite; write a finite one") from None


def _without_none(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _without_none(inner) for key, inner in value.items() if inner is not None}
    if isinstance(value, (list, tuple)):
        return [_without_none(inner) for inner in value]
    return value


def _with_errors(parameter: Mapping[str, Any]) -> dict[str, Any]:
    """Numbers that stand beside their errors, apart."""
    found: dict[str, Any] = {}
    for name in ("bias", "sd", "coverage"):
        value, error = parameter.get(name) or (None, None)
        found.update({name: value, f"{name}_error": error})
    return found
