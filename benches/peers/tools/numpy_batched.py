"""The same regressors for many replicates at once, normal equations instead of a factorisation."""

import numpy as np

from .tool import Tool

# Bytes of regressors built at once: more fall out of the cache, 32 MB took up to 1.4 times as long a sample.
BATCH_BYTES = 8e6
LARGEST_BATCH = 64


class NumpyBatched(Tool):
    """Products by `matmul`, which calls BLAS a replicate."""

    name = "NumPy batched, `matmul`"
    how = "normal equations of a batch of replicates, `numpy.linalg.solve`"

    def batch(self, cell):
        columns = cell.experiment.order * (cell.experiment.points + 1)
        return int(np.clip(BATCH_BYTES / (8 * columns * cell.samples), 1, LARGEST_BATCH))

    def regress(self, cell, y, y0):
        n, m, samples = cell.experiment.order, cell.experiment.points, cell.samples
        y = y - y0[:, None]
        x = np.empty((len(y), samples, n + n * m))
        for i in range(1, n + 1):
            x[:, :, i - 1] = -y[:, n - i : n - i + samples]
            x[:, :, n + (i - 1) * m : n + i * m] = cell.pulses[n - i : n - i + samples]
        theta = np.linalg.solve(*self.normal_equations(x, y[:, n:, None]))[:, :, 0]
        return theta[:, :n], theta[:, n:].reshape(-1, n, m)

    def normal_equations(self, x, y):
        transposed = x.transpose(0, 2, 1)
        return transposed @ x, transposed @ y


class NumpyEinsum(NumpyBatched):
    """Products as most people first write them."""

    name = "NumPy batched, `einsum`"

    def normal_equations(self, x, y):
        return np.einsum("rti,rtj->rij", x, x), np.einsum("rti,rtk->rik", x, y)
