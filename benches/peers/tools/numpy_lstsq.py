"""The loop everybody writes: simulate, stack the regressor, `numpy.linalg.lstsq`."""

import numpy as np

from .tool import Tool


class NumpyLstsq(Tool):
    name = "NumPy per replicate"
    how = "`scipy.signal.lfilter`, dense regressor, `numpy.linalg.lstsq`"

    def regress(self, cell, y, y0):
        n, m = cell.experiment.order, cell.experiment.points
        theta = np.array([lstsq(cell, record - mean) for record, mean in zip(y, y0)])
        return theta[:, :n], theta[:, n:].reshape(-1, n, m)


def lstsq(cell, y):
    n = cell.experiment.order
    lags = [-y[n - i : len(y) - i] for i in range(1, n + 1)]
    pulses = [cell.pulses[n - i : len(y) - i] for i in range(1, n + 1)]
    return np.linalg.lstsq(np.column_stack(lags + pulses), y[n:])[0]
