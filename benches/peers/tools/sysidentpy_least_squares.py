"""SysIdentPy: its lagged matrix and its least squares, the structure given."""

import importlib.metadata

import numpy as np

from .tool import Tool, Unavailable


class SysidentpyLeastSquares(Tool):
    name = "SysIdentPy `LeastSquares`"
    how = "`initial_lagged_matrix`, `LeastSquares().optimize`; no structure selection"

    def __init__(self):
        try:
            from sysidentpy.parameter_estimation import LeastSquares
            from sysidentpy.utils.information_matrix import initial_lagged_matrix
        except ImportError as error:
            raise Unavailable(f"import failed ({error}); pip install -r requirements-sysidentpy.txt") from error
        self.lagged_matrix, self.least_squares = initial_lagged_matrix, LeastSquares()

    def version(self):
        return f"sysidentpy {importlib.metadata.version('sysidentpy')}"

    def regress(self, cell, y, y0):
        n, m = cell.experiment.order, cell.experiment.points
        lags = list(range(1, n + 1))
        theta = []
        for record in y - y0[:, None]:
            # It pads the lags of the first n rows with zeros.
            psi = self.lagged_matrix(cell.pulses, record[:, None], [lags] * m, lags)[n:]
            theta.append(self.least_squares.optimize(psi, record[n:, None])[:, 0])
        theta = np.array(theta)
        # Lags of y come first, then the inputs' one after the other, each with its n lags.
        return -theta[:, :n], theta[:, n:].reshape(-1, m, n).transpose(0, 2, 1)
