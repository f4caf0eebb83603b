"""Switchback itself: the time it takes for the grid, and one of its replicates with the records behind it."""

import json
import os
import resource
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from grid import ROOT, Cell

BINARY = ROOT / "target" / "release" / "leafspring_grid"

# A study of fewer has no standard deviation.
LEAST_REPLICATES = 2


@dataclass(frozen=True)
class Replicate:
    """What Switchback simulated for a cell, and the a, b and F that it estimated."""

    cell: Cell
    y: np.ndarray
    y0: float
    estimate: np.ndarray


class Grid:
    """A whole study with the paper's method on one thread: its estimates, their statistics and its verdicts."""

    how = "the whole study: estimates, standard errors, control variates, theory"

    def __init__(self, replicates):
        self.replicates = replicates

    def seconds(self):
        """Processor time of one replicate of the whole grid."""
        before = children_seconds()
        run(self.replicates)
        return (children_seconds() - before) / self.replicates


def replicate_zero(cells):
    """The first replicate of every cell, sample by sample."""
    with tempfile.TemporaryDirectory() as folder:
        page = run(LEAST_REPLICATES, "--records", folder)
        index = json.loads(Path(folder, "index.json").read_text())
        records = {place(entry): Record(folder, entry) for entry in index if entry["experiment"] == "descendant"}
    estimates = {(*place(found), found["samples"]): found for found in page["cells"]}
    for cell in cells:
        key = (cell.experiment.border.name, cell.experiment.points, cell.noise)
        found, record = estimates[*key, cell.samples], records[key]
        yield Replicate(cell, *record.of(cell), np.r_[found["a"], found["b"], found["borders"]])


def place(entry):
    return entry["border"], entry["points"], entry["noise"]


class Record:
    """A record for all N: a cell uses its beginning."""

    def __init__(self, folder, entry):
        self.v, self.y = (np.fromfile(Path(folder, entry[name]), dtype="<f8") for name in ("v", "y"))
        self.step_means = dict(zip(entry["samples"], entry["step_means"], strict=True))

    def of(self, cell):
        """y and ŷ₀ of a cell, whose input must be the one that the tools are reported."""
        length = cell.experiment.order + cell.samples
        if not np.allclose(self.v[:length], cell.v, rtol=0, atol=1e-9):
            raise ValueError(f"the record's input is not that of {cell}")
        return self.y[:length], self.step_means[cell.samples]


def run(replicates, *options):
    command = [BINARY, str(replicates), *options]
    environment = os.environ | {"RAYON_NUM_THREADS": "1"}
    return json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, env=environment).stdout)


def children_seconds():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime
