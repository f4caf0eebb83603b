"""The same estimates on the same data, or the times mean nothing."""

import numpy as np
import switchback

# The rounding that a comparison may see: normal equations square the condition number, and CSV keeps every digit.
TOLERANCE = 1e-8
SAMPLES = 3000
SEED = 20090706


class Disagreement(Exception):
    """A tool's estimates differ from Switchback's."""


def largest_differences(tools, cells):
    """The largest difference to Switchback's a, b and F over every experiment and noise level, by tool."""
    rng = np.random.Generator(np.random.SFC64(SEED))
    worst = {tool.name: 0.0 for tool in tools}
    for cell in (cell for cell in cells if cell.samples == SAMPLES):
        y, y0 = cell.simulate(rng, 1)
        expected = switchback.identify(cell, y[0], y0[0])
        for tool in tools:
            found = tool.estimate(cell, y, y0)[0]
            worst[tool.name] = max(worst[tool.name], np.abs(found - expected).max())
            if not worst[tool.name] <= TOLERANCE:
                raise Disagreement(f"{tool.name}: {found} against {expected} at {cell}")
    return worst
