"""Figures with matplotlib, an optional extra: ``pip install switchback[plot]``. Each draws rows of a result's own tables."""

from __future__ import annotations

import csv
from typing import TYPE_CHECKING, Any, Optional

import numpy as np

from ._arrays import Floats
from ._native import SwitchbackError

if TYPE_CHECKING:
    from matplotlib.axes import Axes


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


def unknown(kind: str, known: str) -> SwitchbackError:
    """The refusal of a kind of figure."""
    return SwitchbackError(f"there is no plot `{kind}`; the plots are {known}")


def bode(frequency: Floats, magnitude: Floats, phase: Floats, axes: Any) -> Any:
    """Magnitude over phase."""
    upper, lower = axes = _axes(axes, rows=2)
    upper.loglog(frequency, magnitude)
    upper.set_ylabel("magnitude")
    lower.semilogx(frequency, phase)
    _finished(lower, "frequency [Hz]", "phase [°]")
    return axes


def simulation(y: Floats, low: Floats, high: Floats, ax: Optional[Axes]) -> Axes:
    """The outputs with their band."""
    ax = _axes(ax)
    samples = np.arange(len(y))
    ax.fill_between(samples, low, high, alpha=0.3, linewidth=0, label="95 % band")
    ax.plot(samples, y, label="simulated")
    return _finished(ax, "sample")


def probabilities(names: list[str], values: list[float], ax: Optional[Axes]) -> Axes:
    """Bars from 0 to 1."""
    ax = bars(names, {"probability": values}, "probability", ax)
    ax.set_xlim(0, 1)
    return ax


def consistency(cells: list[Any], group: str, ax: Optional[Axes]) -> Axes:
    """Root mean squares over the parameters and cells of a group."""
    ax = _axes(ax)
    for number, method in enumerate(dict.fromkeys(cell.method for cell in cells)):
        own = [cell for cell in cells if cell.method == method]
        samples = sorted({cell.samples for cell in own})
        for name, look, label in (("bias", "o-", method), ("sd", "--", None)):
            sizes = [np.sqrt(np.mean([getattr(cell, name) ** 2 for cell in own if cell.samples == at])) for at in samples]
            ax.loglog(samples, sizes, look, color=f"C{number}", label=label)
    return _finished(ax, "samples N", f"bias (solid) and sd (dashed) of {group}")


def borders(found: Any, labels: tuple[str, str], ax: Optional[Axes]) -> Axes:
    """Borders by their names, with 95 % intervals where errors are known."""
    ax = _axes(ax)
    for name, border in found.items():
        points = [(point.v, point.f, 1.96 * (point.se or 0.0)) for point in border]
        if points:
            v, f, errors = zip(*points)
            ax.errorbar(v, f, errors if any(errors) else None, fmt=".-", capsize=2, label=name)
    return _finished(ax, *labels)


def bars(names: list[str], values: dict[str, list[float]], label: str, ax: Optional[Axes]) -> Axes:
    """Bars of shares, later ones narrower and upon the first."""
    ax = _axes(ax)
    for number, (name, lengths) in enumerate(values.items()):
        ax.barh(names, lengths, height=0.8 - 0.5 * number, label=name if len(values) > 1 else None)
    ax.invert_yaxis()
    return _finished(ax, label)


def loop(text: str, runs: list[str], labels: tuple[str, str], ax: Optional[Axes]) -> Axes:
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
