"""Figures with matplotlib, an optional extra: ``pip install switchback[plot]``."""

from __future__ import annotations

import csv
from typing import TYPE_CHECKING, Any, Optional

import numpy as np

from ._native import SwitchbackError

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._diagnosis import Diagnosis
    from ._identification import Identification
    from ._model import Bode, Model, Simulation
    from ._study import Study


def _axes(ax: Optional[Axes], rows: int = 1) -> Any:
    if ax is not None:
        return ax
    try:
        from matplotlib import pyplot
    except ImportError:
        raise SwitchbackError("figures need matplotlib; install it with `pip install switchback[plot]`") from None
    return pyplot.subplots(rows, 1, sharex=rows > 1)[1]


def _unknown(kind: str, known: str) -> SwitchbackError:
    return SwitchbackError(f"there is no plot `{kind}`; the plots are {known}")


def bode(found: Bode, axes: Any) -> Any:
    """Magnitude over phase."""
    magnitude, phase = axes = _axes(axes, rows=2)
    magnitude.loglog(found.frequency, found.magnitude)
    magnitude.set_ylabel("magnitude")
    phase.semilogx(found.frequency, found.phase)
    phase.set_ylabel("phase [°]")
    phase.set_xlabel("frequency [Hz]")
    return axes


def simulation(run: Simulation, ax: Optional[Axes]) -> Axes:
    """The outputs with their band."""
    ax = _axes(ax)
    samples = np.arange(len(run.y))
    ax.fill_between(samples, run.low, run.high, alpha=0.3, linewidth=0, label="95 % band")
    ax.plot(samples, run.y, label="simulated")
    ax.set_xlabel("sample")
    ax.legend()
    return ax


def borders(model: Model, ax: Optional[Axes]) -> Axes:
    """Both borders of a model."""
    ax = _axes(ax)
    for name, border in (("descending", model.descending), ("ascending", model.ascending)):
        ax.plot([point.v for point in border], [point.f for point in border], ".-", label=name)
    return _labelled(ax, model.input, f"u, {model.output}")


def identification(found: Identification, kind: str, ax: Optional[Axes]) -> Axes:
    """Borders with their errors, or a loop."""
    if kind == "loop":
        return _loop(found._texts["series.csv"], ["simulated"], _labels(found), ax)
    if kind != "borders":
        raise _unknown(kind, "borders and loop")
    ax = _axes(ax)
    for name, border in found.borders.items():
        if border:
            errors = [1.96 * (point.se or 0.0) for point in border]
            ax.errorbar([point.v for point in border], [point.f for point in border], errors, fmt=".-", capsize=2, label=name)
    return _labelled(ax, _labels(found)[0], "u, for u_M − u_m = 1")


def diagnosis(found: Diagnosis, kind: str, ax: Optional[Axes]) -> Axes:
    """One of the figures of a diagnosis."""
    if kind == "loop":
        return _loop(found._texts["series.csv"], ["nominal", "augmented"], ("input", "output"), ax)
    if kind == "borders":
        model = found.augmented or found.nominal
        if model is None:
            raise SwitchbackError("nothing but predictions is known of the model under diagnosis; it has no borders to show")
        return borders(model, ax)
    if kind == "candidates":
        return _candidates(found, ax)
    if kind == "where":
        return _where(found, ax)
    raise _unknown(kind, "where, candidates, loop and borders")


def _candidates(found: Diagnosis, ax: Optional[Axes]) -> Axes:
    ax = _axes(ax)
    shown = found.candidates[:10]
    ax.barh([candidate.effect for candidate in shown], [candidate.probability for candidate in shown])
    ax.invert_yaxis()
    ax.set_xlim(0, 1)
    ax.set_xlabel("probability")
    return ax


def _where(found: Diagnosis, ax: Optional[Axes]) -> Axes:
    """The places in which most more of the gap lies than of the samples."""
    ax = _axes(ax)
    known = [place for place in found.where if place.axis != "record" and place.enrichment is not None]
    shown = sorted(known, key=lambda place: place.share - place.exposure, reverse=True)[:10]
    names = [f"{place.axis} {place.cell} {place.unit or ''}".rstrip() for place in shown]
    ax.barh(names, [place.share for place in shown], label="of the gap's energy")
    ax.barh(names, [place.exposure for place in shown], height=0.3, label="of the samples")
    ax.invert_yaxis()
    ax.set_xlabel("share")
    ax.legend()
    return ax


def study(found: Study, group: str, ax: Optional[Axes]) -> Axes:
    """Root mean squares over a group's parameters and cells."""
    cells = [cell for cell in found.cells if cell.group == group and cell.bias is not None and cell.sd is not None]
    if not cells:
        groups = ", ".join(dict.fromkeys(cell.group for cell in found.cells))
        raise SwitchbackError(f"there is no group `{group}`; the groups are {groups}")
    ax = _axes(ax)
    for method in dict.fromkeys(cell.method for cell in cells):
        own = [cell for cell in cells if cell.method == method]
        samples = sorted({cell.samples for cell in own})

        def size(name: str, at: int, own: Any = own) -> float:
            return float(np.sqrt(np.mean([getattr(cell, name) ** 2 for cell in own if cell.samples == at])))

        (line,) = ax.loglog(samples, [size("bias", at) for at in samples], "o-", label=method)
        ax.loglog(samples, [size("sd", at) for at in samples], "--", color=line.get_color())
    ax.set_xlabel("samples N")
    ax.set_ylabel(f"bias (solid) and sd (dashed) of {group}")
    ax.legend()
    return ax


def _labels(found: Identification) -> tuple[str, str]:
    try:
        return found.model.input, found.model.output
    except SwitchbackError:
        return "input", "output"


def _loop(text: str, runs: list[str], labels: tuple[str, str], ax: Optional[Axes]) -> Axes:
    """The first held-out record, or else the first one, as a loop in the plane of input and output."""
    rows = list(csv.DictReader(text.splitlines()))
    record = next((row["record"] for row in rows if row["use"] == "holdout"), rows[0]["record"])
    rows = [row for row in rows if row["record"] == record]
    v = [float(row["v"]) for row in rows]
    ax = _axes(ax)
    ax.plot(v, [float(row["y"]) for row in rows], color="0.6", label=f"measured, {record}")
    for run in runs:
        if rows[0][run]:
            ax.plot(v, [float(row[run]) for row in rows], linewidth=1, label=run)
    return _labelled(ax, *labels)


def _labelled(ax: Axes, x: str, y: str) -> Axes:
    ax.set_xlabel(x)
    ax.set_ylabel(y)
    ax.legend()
    return ax
