"""GNU Octave's `arx` from its control package, in a process of its own."""

import json
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from grid import SETTLING

from .tool import Tool, Unavailable

SCRIPT = Path(__file__).with_name("octave_arx.m")


class OctaveError(Exception):
    """Octave stopped; the message is what it said."""


class OctaveArx(Tool):
    name = "GNU Octave `arx`"
    how = "`filter`, `arx` of the control package, one input a level"
    largest_samples = 100_000

    def __init__(self):
        self.command = shutil.which("octave-cli")
        if self.command is None:
            raise Unavailable("octave-cli not found; apt-get install octave octave-control, or run.sh --octave")
        try:
            self.versions = self._octave("pkg load control; disp([version ', control ' ver('control').Version])")
        except OctaveError as error:
            raise Unavailable(f"no control package ({error}); apt-get install octave-control") from error

    def version(self):
        return f"octave {self.versions.strip()}"

    def regress(self, cell, y, y0):
        fits = [self._run("estimate", cell, y=record - mean) for record, mean in zip(y, y0)]
        a = np.array([fit["a"] for fit in fits]).reshape(len(y), -1)
        return a, np.array([fit["heights"] for fit in fits])

    def seconds(self, cell, rng):
        return self._run("time", cell, seed=int(rng.integers(1 << 31)))["seconds"]

    def _run(self, task, cell, **extra):
        """Octave reads the job and writes the result as JSON: starting it and reading are not timed."""
        experiment = cell.experiment
        job = {
            "a": experiment.a,
            "samples": cell.samples,
            "noise": cell.noise,
            "settling": SETTLING,
            "period": experiment.period,
            "visits": experiment.visits,
            "forcing": experiment.forcing,
            "step_forcing": experiment.step_forcing,
            **extra,
        }
        with tempfile.TemporaryDirectory() as folder:
            source, target = Path(folder, "job.json"), Path(folder, "result.json")
            source.write_text(json.dumps(job, default=np.ndarray.tolist))
            self._octave(f"addpath('{SCRIPT.parent}'); octave_arx('{task}', '{source}', '{target}')")
            return json.loads(target.read_text())

    def _octave(self, code):
        command = [self.command, "--quiet", "--no-init-file", "--eval", code]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            raise OctaveError(done.stderr.strip())
        return done.stdout
