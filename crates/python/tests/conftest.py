"""What the tests share: the program, the repository's data, and a small machine."""

from __future__ import annotations

import os
import signal
import subprocess
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[3]
BENCH = ROOT / "scenarios/data/bench.csv"
QUICK = ROOT / "scenarios/quick.toml"
LEAF_SPRING = ROOT / "scenarios/rigs/leaf-spring/rig.toml"

# A shell that starts the tests in the background has them ignore interrupts, and Python leaves that as it finds it.
signal.signal(signal.SIGINT, signal.default_int_handler)


def program_path() -> Path:
    """The program that was built from the same sources."""
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    return Path(os.environ.get("SWITCHBACK_PROGRAM", target / "debug/switchback"))


class Program:
    """The command line, run where nothing else lies."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def run(self, *words: object) -> subprocess.CompletedProcess[str]:
        command = [str(program_path()), *map(str, words)]
        return subprocess.run(command, cwd=self.folder, capture_output=True, text=True, check=False)

    def json(self, *words: object) -> str:
        """What it prints with ``--json``."""
        done = self.run(*words, "--json", "--quiet")
        assert done.returncode in (0, 1), done.stderr
        return done.stdout

    def error(self, *words: object) -> str:
        """What it says where it refuses, without the word that begins it."""
        done = self.run(*words, "--quiet")
        assert done.returncode == 2, done.stdout
        assert done.stderr.startswith("error: "), done.stderr
        return done.stderr.removeprefix("error: ").strip()


@pytest.fixture
def program(tmp_path: Path) -> Program:
    if not program_path().exists():
        pytest.fail(f"{program_path()} is missing: `cargo build --features switchback/matlab,switchback/mcap,switchback/mdf,switchback/parquet`, or run .ci/python")
    return Program(tmp_path)


def machine(v: np.ndarray, *, play: float = 0.0, noise: float = 0.0, seed: int = 0) -> np.ndarray:
    """A first-order system behind a leaf spring: what rises runs on one border, what falls on another."""
    rng = np.random.default_rng(seed)
    y, out, position = np.zeros(len(v)), 0.0, v[0]
    rises = True
    for t in range(1, len(v)):
        position = min(max(position, v[t] - play / 2), v[t] + play / 2)
        if v[t] != v[t - 1]:
            rises = v[t] > v[t - 1]
        u = 0.5 * position + (1.0 if rises else -1.0)
        out = 0.6 * out + 0.4 * u + noise * rng.standard_normal()
        y[t] = out
    return y


def drive(samples: int, seed: int = 1) -> np.ndarray:
    """A triangle between random ends, so that both borders are seen all along."""
    rng = np.random.default_rng(seed)
    v, position = [], 0.0
    while len(v) < samples:
        end = rng.uniform(-10, 10)
        steps = max(2, int(abs(end - position) / 0.5))
        v.extend(np.linspace(position, end, steps, endpoint=False))
        position = end
    return np.round(np.array(v[:samples]), 4)


@pytest.fixture(scope="session")
def frame() -> dict[str, np.ndarray]:
    """A short record: time, input, output."""
    v = drive(600)
    return {"time [s]": np.round(0.01 * np.arange(600), 4), "travel [mm]": v, "force [N]": machine(v, noise=0.02)}


@pytest.fixture
def short_csv(tmp_path: Path, frame: dict[str, np.ndarray]) -> Path:
    """The same record as a file, every digit of it."""
    rows = [",".join(frame)] + [",".join(map(repr, map(float, row))) for row in zip(*frame.values())]
    path = tmp_path / "short.csv"
    path.write_text("\n".join(rows) + "\n")
    return path
