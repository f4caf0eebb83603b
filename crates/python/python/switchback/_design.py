"""Designed experiments, planted faults, and which effects records would have shown."""

from __future__ import annotations

import csv
import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Optional, Union

import numpy as np

from . import _native
from ._arrays import Floats
from ._diagnosis import shares
from ._model import Model, model_of
from ._progress import shown
from ._native import SwitchbackError
from ._result import PathLike, Result
from ._rig import Rig, records_of, rig_of
from ._table import Row, Table
from ._options import pair, several, texts


class Design(Result):
    """Experiments to be made: inputs to play, and the rig file that waits for the outputs."""

    @property
    def name(self) -> str:
        """Name of the rig to be measured."""
        return str(self._data["name"])

    @property
    def sample_time(self) -> float:
        """Seconds between samples."""
        return float(self._data["sample_time"])

    @property
    def periods(self) -> int:
        """Periods of each pulse experiment."""
        return int(self._data["periods"])

    @property
    def levels(self) -> dict[str, list[float]]:
        """The levels that the experiments visit on each border, input units."""
        return dict(self._data["levels"])

    @cached_property
    def records(self) -> dict[str, Floats]:
        """The inputs to play by the records' names, input units, each of shape ``(samples,)``."""
        files = {name[:-4]: data.decode() for name, data in self._files.items() if name.endswith(".csv")}
        return {name: np.array([float(row["v"]) for row in csv.DictReader(text.splitlines())]) for name, text in files.items()}

    @property
    def prediction(self) -> Optional[dict[str, Any]]:
        """Standard errors that the plan will reach, where it was made from a rig."""
        found: Optional[dict[str, Any]] = self._data["prediction"]
        return found

    @property
    def roles(self) -> dict[str, Any]:
        """What drives the input of each record: for :meth:`Rig.from_frame`."""
        return {record["file"][:-4]: record["role"] for record in self._data["records"]}

    @property
    def holdout(self) -> list[str]:
        """The records that models are to be judged on."""
        return [record["file"][:-4] for record in self._data["records"] if record["use"] == "holdout"]

    def __repr__(self) -> str:
        return f"Design({self.name!r}, {', '.join(f'{name} ({len(v)})' for name, v in self.records.items())})"


def design(
    order: Optional[int] = None,
    points: Optional[int] = None,
    interval: Optional[tuple[float, float]] = None,
    rate: Optional[float] = None,
    *,
    rig: Optional[PathLike] = None,
    precision: Union[float, str, None] = None,
    method: Optional[str] = None,
    periods: Optional[int] = None,
    duration: Optional[float] = None,
    amplitude: Optional[tuple[float, float]] = None,
    max_speed: Optional[float] = None,
    free_only: bool = False,
    seed: Optional[int] = None,
    input: Optional[str] = None,
    output: Optional[str] = None,
    name: Optional[str] = None,
    out: Optional[PathLike] = None,
) -> Design:
    """Plans the experiments that identify a system, or shows how long to measure.

    Nothing is written; :meth:`Design.save` writes the records and their ``rig.toml``.

    Parameters
    ----------
    order
        Order of the linear part; with ``rig``, else that of the rig.
    points
        Levels to visit on each border; 8, or those of the rig.
    interval
        Working interval of the input, input units.
    rate
        Samples a second.
    rig
        Plan for the system and the noise of this rig, a rig file: in place of ``interval`` and ``rate``.
    precision
        With ``rig``: measure until no border point has a larger standard error, as a share of ``u_M − u_m``: 0.01 or ``"1%"``.
    method
        Method to predict for, ``efficient`` if not given.
    periods, duration
        Periods of each pulse experiment, 100 if not given; or the seconds of all records together.
    amplitude
        Smallest and largest move of the free records, input units.
    max_speed
        What the actuator can do, input units a second: experiments that need more are refused.
    free_only
        Leave the designed experiments out.
    seed
        Seed of the free records, 1 if not given.
    input, output, name
        Labels with units, and the name of the rig to be measured.
    out
        The folder that the plan is meant for, as messages and the JSON object name it.

    Raises
    ------
    SwitchbackError
        In the words of ``switchback design``.
    """
    for option, value in (("order", order), ("interval", interval), ("rate", rate)):
        if value is None and rig is None:
            raise SwitchbackError(f'`{option}` is missing; give order, interval and rate, or rig="rig.toml"')
    options = texts(
        order=order,
        points=points,
        interval=pair(interval, "interval"),
        rate=rate,
        precision=precision,
        method=method,
        periods=periods,
        duration=duration,
        amplitude=pair(amplitude, "amplitude"),
        max_speed=max_speed,
        free_only=free_only,
        seed=seed,
        input=input,
        output=output,
        name=name,
    )
    from_, to = (None if path is None else os.fspath(path) for path in (rig, out))
    return Design(_native.design(options, from_, to))


class Planted(Result):
    """A known fault put into records, and the records with it."""

    def __init__(self, answer: _native.Answer, rig: Rig) -> None:
        super().__init__(answer)
        self._rig = rig

    def __getstate__(self) -> dict[str, Any]:
        return {"_answer": self._answer, "_rig": self._rig}

    @property
    def rig(self) -> Rig:
        """The records with the fault."""
        return self._rig

    @property
    def effect(self) -> str:
        """The effect."""
        return str(self._data["effect"])

    @property
    def law(self) -> str:
        """The law it follows."""
        return str(self._data["law"])

    @property
    def magnitude(self) -> float:
        """How much of it, in :attr:`unit`."""
        return float(self._data["magnitude"])

    @property
    def unit(self) -> str:
        """The unit of the magnitude."""
        return str(self._data["unit"])

    @property
    def size(self) -> float:
        """What survives identification anew, over the residual that the records' own model leaves."""
        return float(self._data["size"])

    @property
    def exact(self) -> bool:
        """Whether it was put into the records themselves, rather than carried by a model."""
        return bool(self._data["exact"])

    @property
    def observable(self) -> bool:
        """Whether these records can show it."""
        return bool(self._data["observable"])

    def __repr__(self) -> str:
        return f"Planted({self.effect}, {self.magnitude:.4g} {self.unit}, size {self.size:.2f})"


def plant(
    rig: Union[Rig, PathLike],
    effect: str,
    size: float = 2.0,
    *,
    law: int = 0,
    seed: int = 1,
    model: Union[Model, Any, PathLike, None] = None,
    progress: Optional[bool] = None,
) -> Planted:
    """Puts a known fault into measured records, to try whether a diagnosis finds it.

    Parameters
    ----------
    rig
        The records, or a file to read them from.
    effect
        ``backlash``, ``creep``, …: ``switchback rig --list`` shows all.
    size
        What survives identification anew, over the residual that the records' own model leaves on held-out ones.
    law
        Which law of the effect, 0 being the plain one.
    seed
        What else there is to the effect is drawn from this.
    model
        The model that carries the effect; else one identified from the fit records.
    progress
        As in :func:`identify`.

    Raises
    ------
    SwitchbackError
        In the words of ``switchback plant``.
    """
    options = texts(effect=effect, size=size, law=law, seed=seed)
    given = None if model is None else model_of(model)
    with shown(progress) as heard:
        answer, records = _native.plant(records_of(rig_of(rig)), options, given, heard)
    return Planted(answer, Rig(records))


@dataclass(frozen=True)
class EffectPower(Row):
    """From which size on an effect would have been found."""

    effect: str
    #: ``from`` (nine in ten are found from ``size`` on), ``not_up_to`` (up to ``size`` they are not), ``undecided``, ``not_planted``.
    outcome: str
    size: Optional[float]
    #: 90 % interval of the size; none at an end beyond the largest size tried.
    ci90: Optional[list[Optional[float]]]
    #: Why it could not be put in.
    reason: Optional[str]
    #: Probability that the next fault of the largest size reached is found.
    found_next: Optional[float]


class Power(Result):
    """Which effects these records would have shown, and from which size on."""

    @property
    def effects(self) -> Table[EffectPower]:
        """One row an effect."""
        return Table(EffectPower.of(effect) for effect in self._data["power"]["effects"])

    def __repr__(self) -> str:
        reported = (f"{one.effect} {one.outcome}" + (f" {one.size:.2g}" if one.size else "") for one in self.effects)
        return f"Power({', '.join(reported)})"


def power(
    rig: Union[Rig, PathLike],
    effects: Union[str, Iterable[str], None] = None,
    *,
    draws: Optional[int] = None,
    seed: Optional[int] = None,
    model: Union[Model, Any, PathLike, None] = None,
    without: Union[str, Iterable[str], None] = None,
    ask: Union[str, Iterable[str], None] = None,
    prior: Optional[Mapping[str, float]] = None,
    threads: Optional[int] = None,
    progress: Optional[bool] = None,
) -> Power:
    """Puts known faults of every effect into the records, diagnoses each, and shows from which size on nine in ten are found.

    Takes minutes; fewer ``effects`` and ``draws`` take less.

    Parameters
    ----------
    rig
        The records, or a file to read them from.
    effects
        Put in only these; else all but those of ``without``.
    draws
        Faults an effect, on average; 6 if not given.
    seed
        Laws, parameters and noise are drawn from this; 1 if not given.
    model, without, ask, prior, threads, progress
        As in :func:`diagnose`.

    Raises
    ------
    SwitchbackError
        In the words of ``switchback gap --power``.
    """
    options = texts(
        effects=several(effects),
        draws=draws,
        seed=seed,
        without=several(without),
        ask=several(ask),
        prior=shares(prior),
        threads=threads,
    )
    given = None if model is None else model_of(model)
    with shown(progress) as heard:
        return Power(_native.power(records_of(rig_of(rig)), options, given, heard))
