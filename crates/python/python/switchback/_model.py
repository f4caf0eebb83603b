"""Models that run on their own."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._arrays import Floats, finite, floats, series
from ._native import SwitchbackError
from ._result import PathLike, Result
from ._table import Estimate, Row, Table
from ._options import Resample, between, texts

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True)
class Point(Row):
    """A point of a border: ``u = f(v)``, with ``u_M − u_m = 1`` in what ``identify`` gives and in output units in a model file."""

    #: The input, input units.
    v: float
    #: The border there.
    f: float
    #: Its standard error, where it is known.
    se: Optional[float] = None


@dataclass(frozen=True)
class Bode:
    """The response of the linear part, ``B(q⁻¹) q^(−delay) / A(q⁻¹)``."""

    #: Hz, shape ``(frequencies,)``.
    frequency: Floats
    #: Complex, in output units for one unit of ``u``, shape ``(frequencies,)``.
    response: NDArray[np.complex128]

    @property
    def magnitude(self) -> Floats:
        """Absolute value of the response."""
        return np.abs(self.response)

    @property
    def phase(self) -> Floats:
        """Degrees, without jumps of a turn."""
        return np.degrees(np.unwrap(np.angle(self.response)))

    def plot(self, axes: Any = None) -> Any:
        """Magnitude and phase over the frequency; needs matplotlib. ``axes`` are two, or made here; they are returned."""
        from . import _plots

        return _plots.bode(self.frequency, self.magnitude, self.phase, axes)


class Simulation(Result):
    """A free run of a model on an input."""

    def __init__(self, answer: _native.Answer, arrays: list[bytes], start: int) -> None:
        super().__init__(answer)
        self._arrays, self._start = arrays, start

    @property
    def v(self) -> Floats:
        """The input, input units, shape ``(samples,)``."""
        return floats(self._arrays[0])

    @property
    def y(self) -> Floats:
        """The output, output units, shape ``(samples,)``; the measured one before :attr:`start`."""
        return floats(self._arrays[1])

    @property
    def low(self) -> Floats:
        """Lower end of the 95 % band for a measured output, shape ``(samples,)``."""
        return floats(self._arrays[2])

    @property
    def high(self) -> Floats:
        """Upper end of that band."""
        return floats(self._arrays[3])

    @property
    def start(self) -> int:
        """First simulated sample; those before it are the initial state."""
        return self._start

    @property
    def fit_percent(self) -> Optional[float]:
        """``100 (1 − ‖y − ŷ‖ / ‖y − ȳ‖)`` from the start on, where outputs were measured."""
        fit: Optional[float] = self._data["fit_percent"]
        return fit

    @property
    def covered(self) -> Optional[float]:
        """Share of the measured outputs within the band."""
        covered: Optional[float] = self._data["covered"]
        return covered

    @property
    def warnings(self) -> list[str]:
        """Where the input leaves what the model was identified on."""
        return list(self._data["warnings"])

    @property
    def notes(self) -> list[str]:
        """What else the reader must know."""
        return list(self._data["notes"])

    def to_csv(self) -> str:
        """The columns ``t,v,y,y_low,y_high``, as ``switchback simulate`` prints them."""
        return self._files["simulated.csv"].decode()

    def __getstate__(self) -> dict[str, Any]:
        return {"_answer": self._answer, "_arrays": self._arrays, "_start": self._start}

    def __eq__(self, other: object) -> bool:
        return super().__eq__(other) and isinstance(other, Simulation) and self._arrays == other._arrays

    __hash__ = Result.__hash__

    def plot(self, ax: Optional[Axes] = None) -> Axes:
        """The outputs with their band; needs matplotlib. Returns the axes."""
        from . import _plots

        return _plots.simulation(self.y, self.low, self.high, ax)


class Model:
    """A model that runs on its own: of an identification or a diagnosis, or read from a file.

    It does not change; it can be pickled, copied, and used from several threads.
    """

    def __init__(self, text: str, name: str = "model.json") -> None:
        try:
            self._data: dict[str, Any] = json.loads(text)
        except json.JSONDecodeError as error:
            raise SwitchbackError(f"{name}: this is no JSON: {error}") from None
        self._text, self._name = text, name

    @classmethod
    def read(cls, file: PathLike) -> Model:
        """Reads a model file, as ``identify --out`` and ``gap --out`` write them.

        Raises ``SwitchbackError`` for what is no JSON, and ``OSError`` for a file that cannot be read.
        """
        return cls(Path(file).read_text(encoding="utf-8"), os.fspath(file))

    def to_json(self) -> str:
        """The model file, to the last byte."""
        return self._text

    def save(self, file: PathLike) -> Path:
        """Writes the model file."""
        Path(file).write_bytes(self._text.encode())
        return Path(file)

    @property
    def rig(self) -> str:
        """Name of the rig that it was identified on."""
        return str(self._data["rig"])

    @property
    def sample_time(self) -> float:
        """Seconds between samples."""
        return float(self._data["sample_time"])

    @property
    def input(self) -> str:
        """Label and unit of the input."""
        return str(self._data["input"])

    @property
    def output(self) -> str:
        """Label and unit of the output."""
        return str(self._data["output"])

    @property
    def effects(self) -> list[str]:
        """What was added to the plain model."""
        return [effect["effect"] for effect in self._data["effects"]]

    @property
    def order(self) -> int:
        """Order ``n`` of the linear part."""
        return int(self._data["system"]["order"])

    @property
    def delay(self) -> int:
        """Samples of delay beyond the one that every lag has; −1 lets ``u(t)`` act on ``y(t)``, less looks ahead."""
        return int(self._data["system"]["delay"])

    @property
    def a(self) -> Floats:
        """``a₁ … aₙ`` of ``A(q⁻¹) = 1 + a₁q⁻¹ + …``, shape ``(n,)``."""
        return np.array(self._data["system"]["a"], dtype=np.float64)

    @property
    def b(self) -> Floats:
        """``b₁ …`` of ``B(q⁻¹)``, shape ``(n + max(0, −delay),)``."""
        return np.array(self._data["system"]["b"], dtype=np.float64)

    @property
    def descending(self) -> Table[Point]:
        """The border on which a falling input runs, ``u`` in output units."""
        return self._border("descending")

    @property
    def ascending(self) -> Table[Point]:
        """The border on which a rising input runs, ``u`` in output units."""
        return self._border("ascending")

    def _border(self, name: str) -> Table[Point]:
        return Table(Point(float(v), float(u)) for v, u in self._data["system"][name] or [])

    def simulate(
        self,
        v: Union[ArrayLike, PathLike],
        y: Optional[ArrayLike] = None,
        *,
        input: Optional[str] = None,
        output: Optional[str] = None,
        time: Optional[str] = None,
        resample: Resample = False,
    ) -> Simulation:
        """Runs the model on an input, with a 95 % band.

        Parameters
        ----------
        v
            The input, input units, shape ``(samples,)``, at the model's sample time; or a file that holds it.
        y
            Measured outputs, output units, shape ``(samples,)``, NaN where none was: the first of them are the initial state, and the fit is
            reported. Without them the run begins at rest, as if the input had always been at its first value.
        input, output, time, resample
            Columns of the file, as in :meth:`Rig.read`; ``output="none"`` to begin at rest.

        Raises
        ------
        SwitchbackError
            For an input that is none, is sampled otherwise, or runs along a border that the model does not know.
        """
        model = model_of(self)
        if isinstance(v, (str, os.PathLike)):
            if y is not None:
                raise SwitchbackError("`y` belongs to an input in memory; a file holds its own")
            options = texts(input=input, output=output, time=time, resample=between(resample))
            return Simulation(*_native.simulate_file(model, os.fspath(v), options))
        given = {"input": input, "output": output, "time": time, "resample": resample}
        for name, value in given.items():
            if value:
                raise SwitchbackError(f"`{name}` belongs to a file; an array has no columns")
        inputs = finite(v, "v")
        outputs = None if y is None else series(y, "y")
        if outputs is not None and len(outputs) != len(inputs):
            raise SwitchbackError(f"`y` has {len(outputs)} values, but `v` has {len(inputs)}")
        if outputs is not None and np.isinf(outputs).any():
            raise SwitchbackError("`y` is infinite somewhere; write NaN where nothing was measured")
        return Simulation(*_native.simulate(model, inputs.tobytes(), None if outputs is None else outputs.tobytes()))

    def bode(self, frequencies: Optional[ArrayLike] = None) -> Bode:
        """The response of the linear part at frequencies, Hz, up to half the sampling rate; else at 200 over three decades up to it."""
        nyquist = 0.5 / self.sample_time
        if frequencies is None:
            grid = np.geomspace(1e-3 * nyquist, nyquist, 200)
        else:
            grid = finite(frequencies, "frequencies")
            if (grid < 0).any() or (grid > nyquist * (1 + 1e-9)).any():
                raise SwitchbackError(f"`frequencies` must lie between 0 and {nyquist} Hz, half the sampling rate")
        shift = np.exp(-2j * np.pi * grid * self.sample_time)
        top = np.polynomial.polynomial.polyval(shift, self.b) * shift ** (1 + self.delay)
        bottom = np.polynomial.polynomial.polyval(shift, np.concatenate([[1.0], self.a]))
        return Bode(grid, top / bottom)

    def export(
        self,
        to: Literal["c", "fmu"],
        file: Optional[PathLike] = None,
        *,
        name: Optional[str] = None,
        library: Optional[PathLike] = None,
    ) -> bytes:
        """Takes the model to where it is needed: a C99 header, or a co-simulation FMU (FMI 2.0).

        Parameters
        ----------
        to
            ``c`` or ``fmu``.
        file
            Where to write it; what stood there is replaced. Without it nothing is written.
        name
            What the model is called in the file; else the name of the file, else that of the rig.
        library
            The library that goes into an FMU; else the one beside the program that runs.

        Returns
        -------
        bytes
            The contents of the file.

        Raises
        ------
        SwitchbackError
            For a model that looks ahead: identify with ``causal=True``. In the words of ``switchback export``.
        """
        library, out = (None if path is None else os.fspath(path) for path in (library, file))
        made = _native.export(model_of(self), texts(to=to, name=name), library, out)
        if file is not None:
            Path(file).write_bytes(made)
        return made

    @cached_property
    def _interval(self) -> tuple[float, float]:
        low, high = self._data["identified_on"]["interval"]
        return float(low), float(high)

    @property
    def interval(self) -> tuple[float, float]:
        """The working interval, input units: beyond it nothing is known."""
        return self._interval

    def plot(self, ax: Optional[Axes] = None) -> Axes:
        """Both borders; needs matplotlib. Returns the axes."""
        from . import _plots

        return _plots.borders({"descending": self.descending, "ascending": self.ascending}, (self.input, f"u, {self.output}"), ax)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Model) and self._text == other._text

    def __hash__(self) -> int:
        return hash(self._text)

    def __repr__(self) -> str:
        with_ = f" with {' and '.join(self.effects)}" if self.effects else ""
        return f"Model(of {self.rig!r}{with_}: order {self.order}, {self.sample_time} s, {self.input} → {self.output})"


def model_of(model: Union[Model, PathLike, Any]) -> tuple[str, str]:
    """What messages call a model, and its text, as the native part takes them."""
    if isinstance(model, (str, os.PathLike)):
        try:
            return os.fspath(model), Path(model).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise SwitchbackError(f"{os.fspath(model)}: cannot be read: {error}") from None
    inner = getattr(model, "model", model)
    if not isinstance(inner, Model):
        raise SwitchbackError(f"a {type(model).__name__} is no model; give a Model, what `identify` gave, or a model file")
    return inner._name, inner._text


def estimate_of(found: Any) -> Estimate:
    """A number with its 90 % interval."""
    return Estimate.of(found)
