"""The same estimates on the same data, and the same law over replicates, or the times mean nothing."""

import numpy as np
import switchback

# The rounding that a comparison may see: normal equations square the condition number, and CSV keeps every digit.
TOLERANCE = 1e-8
SAMPLES = 3000
SEED = 20090706

# The law is compared where replicates are cheap, and in standard errors: some 1,800 of them, so the largest is about 4.
LAW_SAMPLES = 3000
LAW_REPLICATES = 400
LAW_TOLERANCE = 6.0


class Disagreement(Exception):
    """Estimates differ from Switchback's."""


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


def largest_deviation(tool, grid, cells):
    """Means and standard deviations over replicates in the run that is timed, against a tool's own: in standard errors."""
    rng = np.random.Generator(np.random.SFC64(SEED))
    worst = 0.0
    for cell in (cell for cell in cells if cell.samples <= LAW_SAMPLES):
        estimates = tool.estimate(cell, *cell.simulate(rng, LAW_REPLICATES))
        mean, sd, sd_error = grid.moments(cell)
        # Errors of both sides: the tool's replicates are fewer.
        more = np.sqrt(1 + grid.replicates / LAW_REPLICATES)
        of_mean = (estimates.mean(axis=0) - mean) / (sd / np.sqrt(grid.replicates) * more)
        of_sd = (estimates.std(axis=0, ddof=1) - sd) / (sd_error * more)
        worst = max(worst, np.abs(of_mean).max(), np.abs(of_sd).max())
        if not worst <= LAW_TOLERANCE:
            raise Disagreement(f"{tool.name}: over replicates, {worst:.1f} standard errors away at {cell}")
    return worst
