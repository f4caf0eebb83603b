"""SIPPY: a multi-input ARX model, one input a level."""

import importlib.metadata

import numpy as np

from .tool import Tool, Unavailable


class SippyArx(Tool):
    name = "SIPPY `ARX`"
    how = '`system_identification(…, "ARX")`, one input a level'
    largest_samples = 10_000

    def __init__(self):
        try:
            from sippy_unipi import system_identification
        except ImportError as error:
            raise Unavailable(f"import failed ({error}); pip install -r requirements-sippy.txt") from error
        self.identify = system_identification

    def version(self):
        return f"sippy-unipi {importlib.metadata.version('sippy-unipi')}"

    def regress(self, cell, y, y0):
        fits = [self._arx(cell, record - mean) for record, mean in zip(y, y0)]
        return tuple(np.array(parts) for parts in zip(*fits))

    def _arx(self, cell, y):
        n, m = cell.experiment.order, cell.experiment.points
        # Orders of A and of each B, and the delay beyond the one sample that the model has anyway.
        orders = [[n], [[n] * m], [[0] * m]]
        model = self.identify(y[None, :], cell.pulses.T, "ARX", ARX_orders=orders)
        denominator, numerators = np.array(model.DENOMINATOR[0][0]), np.array(model.NUMERATOR[0])
        return denominator[1 : n + 1], numerators[:, :n].T
