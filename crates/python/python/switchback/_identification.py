"""Identification of the linear part and both borders."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from ._arrays import Floats
from ._model import Bode, Model, Point, Simulation
from ._progress import shown
from ._native import SwitchbackError
from ._result import PathLike, Result
from ._rig import Rig, records_of, rig_of
from ._table import Row, Table
from ._options import texts

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Method = Literal["paper-descendant", "paper-ascendant", "joint", "efficient", "instrumental", "free", "linear-arx", "memoryless"]


@dataclass(frozen=True)
class RecordFit(Row):
    """How well a free run follows a record."""

    name: str
    use: str
    samples: int
    #: ``100 (1 − ‖y − ŷ‖ / ‖y − ȳ‖)``; none where the model cannot run on the record.
    fit_percent: Optional[float]


@dataclass(frozen=True)
class Flag(Row):
    """Something that the reader must know before trusting the figures."""

    kind: str
    #: The figure it is about, where there is one.
    figure: Optional[float]
    text: str


class Identification(Result):
    """``A(q⁻¹) y(t) = B(q⁻¹) u(t − delay)``, ``u`` on one of two borders of ``v``; ``b`` and the borders for ``u_M − u_m = 1``."""

    @property
    def method(self) -> str:
        """The method used."""
        return str(self._data["method"])

    @property
    def order(self) -> int:
        """Order ``n`` of the linear part."""
        return int(self._data["order"])

    @property
    def delay(self) -> int:
        """Samples of delay beyond the one that every lag has."""
        return int(self._data["delay"])

    @property
    def a(self) -> Floats:
        """``a₁ … aₙ``, shape ``(n,)``."""
        return _floats(self._data["a"])

    @property
    def a_se(self) -> Floats:
        """Their standard errors; NaN where they are unknown."""
        return _floats(self._data["a_se"])

    @property
    def b(self) -> Floats:
        """``b₁ …``, output units for ``u_M − u_m = 1``, shape ``(n + max(0, −delay),)``."""
        return _floats(self._data["b"])

    @property
    def b_se(self) -> Floats:
        """Their standard errors; NaN where they are unknown."""
        return _floats(self._data["b_se"])

    @property
    def descending(self) -> Table[Point]:
        """The border on which a falling input runs, with standard errors, for ``u_M − u_m = 1``."""
        return Table(Point.of(point) for point in self._data["descendant"])

    @property
    def ascending(self) -> Table[Point]:
        """The border on which a rising input runs."""
        return Table(Point.of(point) for point in self._data["ascendant"])

    @property
    def borders(self) -> dict[str, Table[Point]]:
        """Both borders by their names."""
        return {"descending": self.descending, "ascending": self.ascending}

    @property
    def gain(self) -> float:
        """``B(1)/A(1)``: what restores output units."""
        return float(self._data["gain"])

    @property
    def noise_sd(self) -> float:
        """Standard deviation of the equation error, output units."""
        return float(self._data["noise_sd"])

    @property
    def records(self) -> Table[RecordFit]:
        """How well free runs follow the records."""
        return Table(RecordFit.of(record) for record in self._data["records"])

    @property
    def fit_percent(self) -> dict[str, Optional[float]]:
        """The same by the records' names."""
        return dict(self._data["fit_percent"])

    @property
    def flags(self) -> Table[Flag]:
        """What the reader must know before trusting the figures, weightiest first."""
        return Table(Flag.of(flag) for flag in self._data["flags"])

    @cached_property
    def model(self) -> Model:
        """The same system as a model that runs on its own.

        Raises ``SwitchbackError`` where the estimate cannot run.
        """
        text = self._texts.get("model.json")
        if text is None:
            raise SwitchbackError(
                f"what {self.method} found cannot run on its own; identify from records that run on both borders, or with method='free'"
            )
        return Model(text)

    def simulate(self, v: Union[ArrayLike, PathLike], y: Optional[ArrayLike] = None, **columns: Any) -> Simulation:
        """Runs the model on an input: see :meth:`Model.simulate`."""
        return self.model.simulate(v, y, **columns)

    def bode(self, frequencies: Optional[ArrayLike] = None) -> Bode:
        """The response of the linear part: see :meth:`Model.bode`."""
        return self.model.bode(frequencies)

    def export(self, to: Literal["c", "fmu"], file: Optional[PathLike] = None, **options: Any) -> bytes:
        """Takes the model to where it is needed: see :meth:`Model.export`."""
        return self.model.export(to, file, **options)

    def plot(self, kind: Literal["borders", "loop"] = "borders", ax: Optional[Axes] = None) -> Axes:
        """``borders`` with 95 % intervals, or the ``loop`` of a held-out record beside the model's; needs matplotlib. Returns the axes."""
        from . import _plots

        try:
            labels = self.model.input, self.model.output
        except SwitchbackError:
            labels = "input", "output"
        if kind == "loop":
            return _plots.loop(self._texts["series.csv"], ["simulated"], labels, ax)
        if kind != "borders":
            raise _plots.unknown(kind, "borders and loop")
        return _plots.borders(self.borders, (labels[0], "u, for u_M − u_m = 1"), ax)

    def __repr__(self) -> str:
        fits = ", ".join(f"{name} {fit:.1f} %" for name, fit in self.fit_percent.items() if fit is not None)
        return f"Identification({self.method}, order {self.order}; fit {fits})"


def identify(
    rig: Union[Rig, PathLike],
    method: Optional[Method] = None,
    *,
    causal: bool = False,
    threads: Optional[int] = None,
    progress: Optional[bool] = None,
) -> Identification:
    """Identifies the linear part and both borders from a rig's fit records.

    Parameters
    ----------
    rig
        The records, or a file to read them from.
    method
        ``paper-descendant``, ``paper-ascendant``, ``joint``, ``efficient`` and ``instrumental`` need designed experiments;
        ``free`` takes any record; ``linear-arx`` and ``memoryless`` are what to compare with. Else the best that the records allow.
    causal
        Only models that could run in real time.
    threads
        Worker threads, one a core if not given; results do not depend on it.
    progress
        Whether a bar of tqdm is shown; else where stderr is a terminal or a notebook and tqdm is installed.

    Raises
    ------
    SwitchbackError
        In the words of ``switchback identify``.

    References
    ----------
    Y. Rochdi, F. Giri, F.Z. Chaoui, 15th IFAC SYSID, 2009, doi 10.3182/20090706-3-FR-2004.0370.
    """
    options = texts(method=method, causal=causal, threads=threads)
    with shown(progress) as heard:
        return Identification(_native.identify(records_of(rig_of(rig)), options, heard))


def _floats(numbers: list[Optional[float]]) -> Floats:
    return np.array([np.nan if number is None else number for number in numbers], dtype=np.float64)
