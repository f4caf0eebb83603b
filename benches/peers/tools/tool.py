"""What every tool must offer."""

import time
from abc import ABC, abstractmethod

import paper


class Unavailable(Exception):
    """The tool cannot run here; the message says why and what to do."""


class Tool(ABC):
    """The same work, cell by cell: simulate both experiments, regress, convert to a, b and F."""

    name: str
    # How it goes about the work, for the table.
    how: str
    # Cells of more samples are not timed; None times the whole grid.
    largest_samples: int | None = None

    def version(self):
        """Of whatever does the regression."""
        import numpy
        import scipy

        return f"numpy {numpy.__version__}, scipy {scipy.__version__}"

    def batch(self, cell):
        """Replicates worked on at once."""
        return 1

    @abstractmethod
    def regress(self, cell, y, y0):
        """Least squares (3.21) on ỹ = y − y0, a record a row: a (R × n) and pulse heights (R × n × m)."""

    def estimate(self, cell, y, y0):
        """a, b and F of given records, a row a record."""
        return paper.estimate(cell.experiment, *self.regress(cell, y, y0), y0)

    def seconds(self, cell, rng):
        """Processor time of one replicate of one cell, the simulation included."""
        replicates = self.batch(cell)
        start = time.process_time()
        self.estimate(cell, *cell.simulate(rng, replicates))
        return (time.process_time() - start) / replicates
