"""What someone who knows the structure writes: sufficient statistics by slices and `reshape`, cell by cell.

At each phase of the period at most one pulse column is active. So its coefficient is a mean over one phase, and a is the
regression on lags within phases: a few lag products and one fold of y instead of a dense regressor.
"""

import numpy as np

from .tool import Tool


class NumpyExpert(Tool):
    name = "NumPy, expert's"
    how = "lag products by slices, period fold by `reshape`, within-phase regression"

    def regress(self, cell, y, y0):
        fits = [within_phases(cell, record - mean) for record, mean in zip(y, y0)]
        return tuple(np.array(parts) for parts in zip(*fits))


def within_phases(cell, y):
    experiment = cell.experiment
    n = experiment.order
    products = lag_products(y, n)
    sums, counts = lagged_folds(y, n, experiment.period)
    # phases[i, j]: where level j was visited i + 1 samples ago.
    phases = (experiment.visits + np.arange(1, n + 1)[:, None]) % experiment.period
    pulse_sums, pulse_counts = sums[:, phases.ravel()], counts[phases.ravel()]
    within = products - (pulse_sums / pulse_counts) @ pulse_sums.T
    a = np.linalg.solve(within[1:, 1:], -within[1:, 0])
    heights = (np.r_[1.0, a] @ pulse_sums / pulse_counts).reshape(phases.shape)
    return a, heights


def lag_products(y, n):
    """Σ_t y(t−i) y(t−l) for 0 ≤ i, l ≤ n: the first row in full, the others from it by their two edges."""
    rows = len(y) - n
    products = np.empty((n + 1, n + 1))
    for lag in range(n + 1):
        products[0, lag] = y[n:] @ y[n - lag : n - lag + rows]
        for i in range(1, n + 1 - lag):
            entering, leaving = n - i, n - i + rows
            edges = y[entering] * y[entering - lag] - y[leaving] * y[leaving - lag]
            products[i, i + lag] = products[i - 1, i - 1 + lag] + edges
    return np.triu(products) + np.triu(products, 1).T


def lagged_folds(y, n, period):
    """Σ over t ≡ p (mod T) of y(t−l), a row a lag l, and the number of such t."""
    rows = len(y) - n
    whole, rest = divmod(rows, period)
    fold = y[n : n + whole * period].reshape(whole, period).sum(axis=0)
    fold[:rest] += y[n + whole * period :]
    sums = np.empty((n + 1, period))
    sums[0] = fold
    for lag in range(1, n + 1):
        # One sample later, every sum has moved by a phase; one sample enters in front and one leaves at the end.
        sums[lag] = np.roll(sums[lag - 1], 1)
        sums[lag, 0] += y[n - lag]
        sums[lag, rows % period] -= y[n - lag + rows]
    return sums, whole + (np.arange(period) < rest)
