"""Switchback itself: its estimates for the check, its time for the grid."""

import json
import os
import re
import resource
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from grid import ROOT, SCENARIO, Border

BINARY = ROOT / "target" / "release" / "switchback"


def identify(cell, y, y0):
    """a, b and F by `switchback identify --method paper-descendant` from one record and the mean of its step."""
    experiment = cell.experiment
    low, high = experiment.interval
    rig = f"""
name = "peer check"
sample_time = 1.0
order = {experiment.order}
[[record]]
file = "pulses.csv"
role = "descendant"
use = "fit"
[[record]]
file = "step.csv"
role = "step_high"
use = "fit"
"""
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "rig.toml").write_text(rig)
        # Both records begin with the sample that loads the border, which no estimate uses. The step is given as its
        # mean, so that ŷ₀ is the same whichever samples are taken for its transient.
        write_record(folder / "pulses.csv", np.r_[low, cell.v], np.r_[y0, y])
        write_record(folder / "step.csv", np.r_[low, np.full(400, high)], np.full(401, y0))
        command = [BINARY, "identify", folder / "rig.toml", "--method", "paper-descendant", "--json"]
        page = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    visited = [point["v"] for point in page["descendant"]]
    if not np.allclose(visited, experiment.levels, rtol=0, atol=1e-9):
        raise ValueError(f"identify found the levels {visited}, not {list(experiment.levels)}")
    return np.r_[page["a"], page["b"], [point["f"] for point in page["descendant"]]]


def write_record(path, v, y):
    rows = (f"{t},{x!r},{z!r}" for t, (x, z) in enumerate(zip(v.tolist(), y.tolist())))
    path.write_text("t,v,y\n" + "\n".join(rows) + "\n")


class Grid:
    """`switchback SCENARIO.toml` on the grid with the paper's method only, everything it reports included."""

    how = "`switchback SCENARIO.toml`, with everything it reports"

    def __init__(self, replicates):
        self.replicates = replicates
        # The results.json of the last run: the same every time.
        self.results = None

    def seconds(self):
        """Processor time of one replicate of the whole grid, one thread."""
        with tempfile.TemporaryDirectory() as folder:
            scenario = Path(folder, "leafspring.toml")
            scenario.write_text(only_paper(SCENARIO.read_text(), self.replicates))
            before = children_seconds()
            environment = os.environ | {"RAYON_NUM_THREADS": "1"}
            subprocess.run([BINARY, scenario], check=True, capture_output=True, cwd=folder, env=environment)
            seconds = children_seconds() - before
            self.results = json.loads(Path(folder, "reports", "leafspring", "results.json").read_text())
        return seconds / self.replicates

    def moments(self, cell):
        """Mean and sd of a, b and F over the replicates of a cell, and the Monte-Carlo error of the sd."""
        experiment = cell.experiment
        for found in self.results["cells"]:
            series = found["series"]
            place = (self.border(series["border"]), series["points"], series["noise"], found["samples"])
            if place == (experiment.border, experiment.points, cell.noise, cell.samples):
                parameters = found["parameters"]
                return tuple(
                    np.array(column)
                    for column in zip(*((p["mean_estimate"], p["sd"][0], p["sd"][1]) for p in parameters))
                )
        raise ValueError(f"the study has no {cell}")

    def border(self, name):
        """The border that a scenario calls so."""
        found = next(b for b in self.results["scenario"]["border"] if b["name"] == name)
        return Border(found["stiffness"], found.get("hardening", 0.0), found["friction"])


def only_paper(text, replicates):
    """The scenario with one method, another number of replicates and nothing expected."""
    text = re.sub(r"(?m)^methods = .*$", 'methods = ["paper-descendant"]', text)
    text = re.sub(r"(?m)^replicates = .*$", f"replicates = {replicates}", text)
    return text.split("[expect]")[0]


def children_seconds():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime
