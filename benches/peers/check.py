"""The same estimates on the same data, or the times mean nothing."""

import numpy as np

# Rounding: normal equations square the condition number, which stays below 300 on this grid.
TOLERANCE = 1e-8

# Slow tools are checked in every experiment and noise level, but at this N only.
SLOW_SAMPLES = 3000


class Disagreement(Exception):
    """A tool's estimates differ from Switchback's."""


def largest_differences(tools, replicates):
    """The largest difference of a, b and F to Switchback's on its own records, by tool."""
    worst = {tool.name: 0.0 for tool in tools}
    for replicate in replicates:
        for tool in tools:
            if tool.largest_samples is None or replicate.cell.samples == SLOW_SAMPLES:
                worst[tool.name] = max(worst[tool.name], difference(tool, replicate))
    return worst


def difference(tool, replicate):
    found = tool.estimate(replicate.cell, replicate.y[None, :], np.array([replicate.y0]))[0]
    largest = np.abs(found - replicate.estimate).max()
    # Written so that a NaN is refused, too.
    if not largest <= TOLERANCE:
        raise Disagreement(f"{tool.name}: {found} against {replicate.estimate} at {replicate.cell}")
    return largest
