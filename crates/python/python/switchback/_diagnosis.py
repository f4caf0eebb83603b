"""Diagnosis of the gap between a model and a rig."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, Optional, Union

from numpy.typing import ArrayLike

from . import _native
from ._model import Model, model_of
from ._native import SwitchbackError
from ._progress import shown
from ._result import PathLike, Result
from ._rig import Rig, records_of, rig_of
from ._table import Estimate, Row, Table
from ._options import number, several, texts

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True)
class Verdict(Row):
    """What causes the gap."""

    #: ``none``, ``refit``, ``named``, ``class`` (effects that no record here separates), ``ambiguous``, or ``unexplained``.
    status: str
    #: The effects found.
    effects: list[str]
    #: The effects, one of which it is.
    class_: list[str]
    #: ``input``, ``operator``, ``dynamics``, ``disturbance`` or ``sensor``.
    stage: Optional[str]
    probability: float
    #: Whether the probability is a frequency on records like these.
    calibrated: bool
    #: The effect that takes what the first one's law leaves.
    corrected_by: Optional[str]
    #: Order, delay and closure of a model identified anew.
    refit: Optional[dict[str, Any]]


@dataclass(frozen=True)
class RecordGap(Row):
    """The gap on one record, as a share of the output's variance beyond the noise."""

    record: str
    before: float
    after: Optional[float]
    fit_before: Optional[float]
    fit_after: Optional[float]


@dataclass(frozen=True)
class Gap:
    """How large the gap is, as a share of the output's variance beyond the noise, with 90 % intervals."""

    before: Estimate
    after: Estimate
    #: Share of it that adding the effects closes on held-out records.
    closure: Estimate
    #: Standard deviation of the noise, output units.
    noise_floor: float
    per_record: Table[RecordGap]


@dataclass(frozen=True)
class Parameter(Row):
    """A parameter of an effect in the user's units."""

    name: str
    value: Optional[float]
    ci90: Optional[list[Optional[float]]]
    unit: str

    def __str__(self) -> str:
        reported = "–" if self.value is None else f"{self.value:.4g}"
        return f"{self.name} {reported} {self.unit}".rstrip()


@dataclass(frozen=True)
class Candidate(Row):
    """A candidate of the gap."""

    effect: str
    stage: str
    probability: float
    #: Share of the gap that it closes on held-out records.
    closure: Optional[float]
    #: Drop of the Bayesian information criterion.
    delta_bic: Optional[float]
    heldout_log_score: Optional[float]
    parameters: Table[Parameter]

    @classmethod
    def of(cls, found: Mapping[str, Any]) -> Candidate:
        """That of an object in the program's JSON."""
        parameters = Table(Parameter.of(parameter) for parameter in found["parameters"])
        return super().of({**found, "parameters": parameters})

    def cells(self) -> dict[str, Any]:
        """The row as cells of a data frame; parameters in words."""
        return {**super().cells(), "parameters": ", ".join(map(str, self.parameters))}


@dataclass(frozen=True)
class Difference(Row):
    """A quantity of the machine beside that of the model, simulator or records compared with it."""

    what: str
    #: ``parameter``, which both sides have, or ``effect``.
    kind: str
    #: The effect whose parameter it is.
    effect: Optional[str]
    differs: bool
    #: Its value in what was compared with the machine, a delay relative to the machine's; 0 for the strength of an effect that this lacks.
    in_a: Optional[float]
    #: Its value in the machine.
    in_b: float
    #: Standard error of the latter.
    se: float
    unit: str
    #: Probability that the values differ.
    probability: float
    #: Share of the gap that would stay without aligning this one.
    closure: float
    #: The attribute of a MuJoCo joint that it is.
    attribute: Optional[str]


@dataclass(frozen=True)
class Place(Row):
    """A part of the records, and how much of the gap lies there."""

    axis: str
    cell: str
    low: Optional[float]
    high: Optional[float]
    unit: Optional[str]
    #: Share of the gap's energy.
    share: float
    #: Share of the samples.
    exposure: float
    #: ``share / exposure``.
    enrichment: Optional[float]
    #: False discovery rate at which the gap there is significant.
    q_value: Optional[float]


@dataclass(frozen=True)
class PartVerdict(Row):
    """The verdict of a part of the records."""

    #: The recording, or the number of the sample.
    part: str
    verdict: str
    #: Whether it is that of all records.
    agrees: bool


@dataclass(frozen=True)
class Stability:
    """The verdicts of parts of the records."""

    #: Share of all parts with the verdict of all records.
    share: Optional[float]
    #: Samples of three quarters of the records.
    samples: Table[PartVerdict]
    #: Each recording alone; empty where there is only one.
    recordings: Table[PartVerdict]


class Diagnosis(Result):
    """Where a model misses measured data, which effect causes it, and how far adding that closes the gap."""

    @property
    def verdict(self) -> Verdict:
        """What causes the gap."""
        return Verdict.of(self._data["verdict"])

    @property
    def gap(self) -> Gap:
        """How large it is, before and after the effects found are added."""
        found = self._data["gap"]
        before, after, closure = (Estimate.of(found[name]) for name in ("before", "after", "closure"))
        per_record = Table(RecordGap.of(record) for record in found["per_record"])
        return Gap(before, after, closure, float(found["noise_floor"]), per_record)

    @property
    def closure(self) -> Estimate:
        """Share of the gap that adding the effects closes on held-out records, with its 90 % interval."""
        return self.gap.closure

    @cached_property
    def candidates(self) -> Table[Candidate]:
        """The candidates, best first."""
        return Table(Candidate.of(candidate) for candidate in self._data["candidates"])

    @cached_property
    def differences(self) -> Table[Difference]:
        """Every quantity on both sides, those that differ first; empty where the model was identified from the rig's own records."""
        return Table(Difference.of(difference) for difference in self._data["differences"])

    @cached_property
    def stability(self) -> Optional[Stability]:
        """Which parts of the records give the same verdict; none where that was not asked for."""
        found = self._data.get("stability")
        if found is None:
            return None
        samples, recordings = (Table(PartVerdict.of(part) for part in found[name]) for name in ("samples", "recordings"))
        return Stability(found["share"], samples, recordings)

    @cached_property
    def where(self) -> Table[Place]:
        """Where the gap lies."""
        return Table(Place.of(place) for place in self._data["where"])

    @property
    def limitations(self) -> list[str]:
        """What the reader must know."""
        return list(self._data["limitations"])

    @property
    def next_experiment(self) -> Optional[dict[str, Any]]:
        """The measurement that separates the candidates; none where none is needed."""
        experiment: Optional[dict[str, Any]] = self._data["next_experiment"]
        return experiment

    @cached_property
    def nominal(self) -> Optional[Model]:
        """The model under diagnosis, where more than its predictions are known."""
        return self._model("nominal.json")

    @cached_property
    def augmented(self) -> Optional[Model]:
        """The same with what was found added: the repaired model."""
        return self._model("augmented.json")

    def _model(self, name: str) -> Optional[Model]:
        text = self._texts.get(name)
        return None if text is None else Model(text, name)

    def explain(self) -> str:
        """Why the first candidate comes first: the errors that each saves, by how far ahead it predicts."""
        return self._texts["why"]

    def plot(self, kind: Literal["where", "candidates", "loop", "borders"] = "where", ax: Optional[Axes] = None) -> Axes:
        """``where`` the gap lies, the ``candidates``, the ``loop`` of a held-out record beside the models', or the ``borders`` of the repaired
        model; needs matplotlib. Returns the axes."""
        from . import _plots

        if kind == "loop":
            return _plots.loop(self._texts["series.csv"], ["nominal", "augmented"], ("input", "output"), ax)
        if kind == "borders":
            model = self.augmented or self.nominal
            if model is None:
                raise SwitchbackError("nothing but predictions is known of the model under diagnosis; it has no borders to show")
            return model.plot(ax)
        if kind == "candidates":
            first = self.candidates[:10]
            return _plots.probabilities([one.effect for one in first], [one.probability for one in first], ax)
        if kind == "where":
            # The places in which most more of the gap lies than of the samples.
            known = [place for place in self.where if place.axis != "record" and place.enrichment is not None]
            places = sorted(known, key=lambda place: place.share - place.exposure, reverse=True)[:10]
            names = [f"{place.axis} {place.cell} {place.unit or ''}".rstrip() for place in places]
            shares = {"of the gap's energy": [place.share for place in places], "of the samples": [place.exposure for place in places]}
            return _plots.bars(names, shares, "share", ax)
        raise _plots.unknown(kind, "where, candidates, loop and borders")

    def __repr__(self) -> str:
        verdict = self.verdict
        cause = " and ".join(verdict.effects or verdict.class_ or []) or verdict.status
        return f"Diagnosis({cause}, probability {verdict.probability:.2f}; closes {self.closure})"


def diagnose(
    rig: Union[Rig, PathLike],
    model: Union[Model, Any, PathLike, None] = None,
    y_sim: Union[ArrayLike, Mapping[str, ArrayLike], None] = None,
    *,
    without: Union[str, Iterable[str], None] = None,
    ask: Union[str, Iterable[str], None] = None,
    causal: bool = False,
    prior: Optional[Mapping[str, float]] = None,
    posterior: Optional[PathLike] = None,
    stability: Optional[int] = None,
    threads: Optional[int] = None,
    progress: Optional[bool] = None,
) -> Diagnosis:
    """Says where a model misses a rig's held-out records, which of the known effects causes it, and how far the gap closes.

    Parameters
    ----------
    rig
        The records, or a file to read them from.
    model
        The model to diagnose: a :class:`Model`, what :func:`identify` gave, or a model file; else that of the predictions ``y_sim``
        where the records have them, else the one identified from the fit records.
    y_sim
        Another simulator's predictions of the output, to be diagnosed: see :meth:`Rig.with_y_sim`.
    without
        Effects that the rig is known not to have.
    ask
        Effects to show as a cause where else they belong to the model: ``coloured_noise``.
    causal
        Only nominal models that could run in real time, so that they can be exported.
    prior
        How common it is, on machines like yours, that nothing is missing, and that the cause is none of the effects, e.g.
        ``{"none": 0.2, "unexplained": 0.1}``: for records that nobody designed.
    posterior
        Decide by this posterior, a file that ``switchback train`` has trained, on records that nobody designed; else rules decide, and the one built in
        where these show none of the candidates.
    stability
        Also diagnose so many samples of three quarters of the records, and each recording alone: :attr:`Diagnosis.stability`.
    threads, progress
        As in :func:`identify`.

    Raises
    ------
    SwitchbackError
        In the words of ``switchback gap``.
    """
    rig = rig_of(rig)
    if y_sim is not None:
        rig = rig.with_y_sim(y_sim)
    options = texts(
        without=several(without),
        ask=several(ask),
        causal=causal,
        prior=shares(prior),
        posterior=None if posterior is None else str(posterior),
        stability=stability,
        threads=threads,
    )
    given = None if model is None else model_of(model)
    with shown(progress) as heard:
        return Diagnosis(_native.diagnose(records_of(rig), options, given, None, heard))


def compare(
    a: Union[Rig, Model, Any, PathLike, ArrayLike, Mapping[str, ArrayLike]],
    b: Union[Rig, PathLike],
    *,
    threads: Optional[int] = None,
    progress: Optional[bool] = None,
) -> Table[Difference]:
    """Every quantity of ``a`` beside that of the machine ``b``: those that differ first, with what aligning each closes.

    ``compare(monday, tuesday).to_pandas()`` is a frame, a row a quantity. :func:`diagnose` says the same in sentences.

    Parameters
    ----------
    a
        What is compared: records of another day or unit (a :class:`Rig`, or a file of measurements), a model (a :class:`Model`, what
        :func:`identify` gave, or a model file ``.json``), or a simulator's predictions on the records of ``b``, as for :meth:`Rig.with_y_sim`.
    b
        The records of the machine, or a file to read them from.
    threads, progress
        As in :func:`identify`.

    Raises
    ------
    SwitchbackError
        In the words of ``switchback gap``.
    """
    machine = rig_of(b)
    options = texts(threads=threads)
    model, against = None, None
    if isinstance(a, Rig):
        against = a
    elif isinstance(a, (str, os.PathLike)):
        if str(a).endswith(".json"):
            model = model_of(a)
        else:
            against = Rig.read(a)
    elif isinstance(a, Model) or hasattr(a, "model"):
        model = model_of(a)
    else:
        machine = machine.with_y_sim(a)
    with shown(progress) as heard:
        others = None if against is None else records_of(against)
        return Diagnosis(_native.diagnose(records_of(machine), options, model, others, heard)).differences


def shares(prior: Optional[Mapping[str, float]]) -> Optional[str]:
    """``none=0.2,unexplained=0.1``"""
    return None if prior is None else ",".join(f"{name}={number(share)}" for name, share in prior.items())
