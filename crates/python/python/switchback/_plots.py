"""Figures with matplotlib, an optional extra: ``pip install switchback[plot]``. Each draws rows of a result's own tables."""

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


def _finished(ax: Axes, x: str, y: str = "") -> Axes:
    ax.set_xlabel(x)
    ax.set_ylabel(y)
    if ax.get_legend_handles_labels()[0]:
        ax.legend()
    return ax


def _unknown(kind: str, known: str) -> SwitchbackError:
    return SwitchbackError(f"there is no plot `{kind}`; the plots are {known}")


def bode(found: Bode, axes: Any) -> Any:
    """Magnitude over phase."""
    magnitude, phase = axes = _axes(axes, rows=2)
    magnitude.loglog(found.frequency, found.magnitude)
    magnitude.set_ylabel("magnitude")
    phase.semilogx(found.frequency, found.phase)
    _finished(phase, "frequency [Hz]", "phase [°]")
    return axes


def simulation(run: Simulation, ax: Optional[Axes]) -> Axes:
    """The outputs with their band."""
    ax = _axes(ax)
    samples = np.arange(len(run.y))
    ax.fill_between(samples, run.low, run.high, alpha=0.3, linewidth=0, label="95 % band")
    ax.plot(samples, run.y, label="simulated")
    return _finished(ax, "sample")


def borders(model: Model, ax: Optional[Axes]) -> Axes:
    """Both borders of a model."""
    return _borders({"descending": model.descending, "ascending": model.ascending}, (model.input, f"u, {model.output}"), ax)


def identification(found: Identification, kind: str, ax: Optional[Axes]) -> Axes:
    """Borders with their errors, or a loop."""
    try:
        labels = found.model.input, found.model.output
    except SwitchbackError:
        labels = "input", "output"
    if kind == "loop":
        return _loop(found._texts["series.csv"], ["simulated"], labels, ax)
    if kind != "borders":
        raise _unknown(kind, "borders and loop")
    return _borders(found.borders, (labels[0], "u, for u_M − u_m = 1"), ax)


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
        shown = found.candidates[:10]
        ax = _bars([one.effect for one in shown], {"probability": [one.probability for one in shown]}, "probability", ax)
        ax.set_xlim(0, 1)
        return ax
    if kind == "where":
        # The places in which most more of the gap lies than of the samples.
        known = [place for place in found.where if place.axis != "record" and place.enrichment is not None]
        places = sorted(known, key=lambda place: place.share - place.exposure, reverse=True)[:10]
        names = [f"{place.axis} {place.cell} {place.unit or ''}".rstrip() for place in places]
        shares = {"of the gap's energy": [place.share for place in places], "of the samples": [place.exposure for place in places]}
        return _bars(names, shares, "share", ax)
    raise _unknown(kind, "where, candidates, loop and borders")


def study(found: Study, group: str, ax: Optional[Axes]) -> Axes:
    """Root mean squares over a group's parameters and cells."""
    cells = [cell for cell in found.cells if cell.group == group and cell.bias is not None and cell.sd is not None]
    if not cells:
        groups = ", ".join(dict.fromkeys(cell.group for cell in found.cells))
        raise SwitchbackError(f"there is no group `{group}`; the groups are {groups}")
    ax = _axes(ax)
    for number, method in enumerate(dict.fromkeys(cell.method for cell in cells)):
        own = [cell for cell in cells if cell.method == method]
        samples = sorted({cell.samples for cell in own})
        for name, look, label in (("bias", "o-", method), ("sd", "--", None)):
            sizes = [np.sqrt(np.mean([getattr(cell, name) ** 2 for cell in own if cell.samples == at])) for at in samples]
            ax.loglog(samples, sizes, look, color=f"C{number}", label=label)
    return _finished(ax, "samples N", f"bias (solid) and sd (dashed) of {group}")


def _borders(found: Any, labels: tuple[str, str], ax: Optional[Axes]) -> Axes:
    ax = _axes(ax)
    for name, border in found.items():
        points = [(point.v, point.f, 1.96 * (point.se or 0.0)) for point in border]
        if points:
            v, f, errors = zip(*points)
            ax.errorbar(v, f, errors if any(errors) else None, fmt=".-", capsize=2, label=name)
    return _finished(ax, *labels)


def _bars(names: list[str], values: dict[str, list[float]], label: str, ax: Optional[Axes]) -> Axes:
    """Bars of shares, later ones narrower and upon the first."""
    ax = _axes(ax)
    for number, (name, lengths) in enumerate(values.items()):
        ax.barh(names, lengths, height=0.8 - 0.5 * number, label=name if len(values) > 1 else None)
    ax.invert_yaxis()
    return _finished(ax, label)


def _loop(text: str, runs: list[str], labels: tuple[str, str], ax: Optional[Axes]) -> Axes:
    """The first held-out record, or else the first one, as a loop in the plane of input and output."""
    rows = list(csv.DictReader(text.splitlines()))
    record = next((row["record"] for row in rows if row["use"] == "holdout"), rows[0]["record"])
    rows = [row for row in rows if row["record"] == record]
    column = {name: [float(row[name]) for row in rows] for name in ("v", "y", *runs) if rows[0][name]}
    ax = _axes(ax)
    ax.plot(column["v"], column["y"], color="0.6", label=f"measured, {record}")
    for run in (run for run in runs if run in column):
        ax.plot(column["v"], column[run], linewidth=1, label=run)
    return _finished(ax, *labels)
