"""The leaf-spring grid: its cells, and the records that every tool is given."""

import itertools
import tomllib
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from scipy.signal import lfilter

ROOT = Path(__file__).resolve().parents[2]
SCENARIO = ROOT / "scenarios" / "leafspring.toml"

# Samples simulated and dropped before a record, so that the start from rest is forgotten: the poles have modulus
# 0.67, and 0.67^100 is below the rounding of a double.
SETTLING = 100


@dataclass(frozen=True)
class Border:
    """A leaf spring, C(x) = (k0 + k2 x²) x ± F_C: the ascending border takes the plus."""

    name: str
    stiffness: float
    hardening: float
    friction: float

    def ascending(self, x):
        return (self.stiffness + self.hardening * x * x) * x + self.friction

    def descending(self, x):
        return (self.stiffness + self.hardening * x * x) * x - self.friction


@dataclass(frozen=True)
class Experiment:
    """The descendant experiment (3.1) with m levels on one border pair: everything that noise does not touch."""

    a: tuple
    b: tuple
    interval: tuple
    border: Border
    points: int

    @property
    def order(self):
        return len(self.a)

    @property
    def spacing(self):
        """Samples between visits: below 2 the input would climb from one level to the next."""
        return max(self.order, 2)

    @property
    def period(self):
        return self.spacing * (self.points + 3)

    @cached_property
    def levels(self):
        """V_1 … V_m, evenly spaced from h_m, one step short of h_M."""
        low, high = self.interval
        j = np.arange(self.points)
        return (low * (self.points - j) + high * j) / self.points

    @cached_property
    def visits(self):
        """The phase of each level's visit: 2s for the first, (2 + j)s for V_j."""
        return self.spacing * np.r_[2, np.arange(4, self.points + 3)]

    @property
    def u_high(self):
        return self.border.ascending(self.interval[1])

    @cached_property
    def v(self):
        """One period of the input."""
        v = np.full(self.period, self.interval[1])
        v[self.visits] = self.levels
        return v

    @cached_property
    def forcing(self):
        """One period of B(q⁻¹)u: u is u_M at the satellite and C_d(V_j) in a visit, because each visit is a fall."""
        u = np.full(self.period, self.u_high)
        u[self.visits] = self.border.descending(self.levels)
        return sum(b * np.roll(u, i) for i, b in enumerate(self.b, start=1))

    @property
    def step_forcing(self):
        """B(q⁻¹)u while the input rests at the satellite."""
        return sum(self.b) * self.u_high


@dataclass(frozen=True)
class Cell:
    """One experiment at one noise level and one number of regression rows N."""

    experiment: Experiment
    noise: float
    samples: int

    @cached_property
    def v(self):
        """The input of a record: n samples that only serve as lags, then N from phase 0 on."""
        order = self.experiment.order
        return over_time(self.experiment.v, -order, order + self.samples)

    @cached_property
    def pulses(self):
        """1 where the input visits level j, else 0: as many rows as `v`, a column a level."""
        return (self.v[:, None] == self.experiment.levels).astype(float)

    @cached_property
    def drive(self):
        before = SETTLING + self.experiment.order
        return over_time(self.experiment.forcing, -before, before + self.samples)

    def prepare(self):
        """Computes what a user computes once a cell, before the replicates."""
        return self.drive, self.pulses

    def simulate(self, rng, replicates):
        """Records of `replicates` experiments (a row each) and the means of as many step experiments of N samples."""
        y = self._respond(self.drive, rng, replicates)
        step = self._respond(self.experiment.step_forcing, rng, replicates)
        return y, step[:, self.experiment.order :].mean(axis=1)

    def _respond(self, forcing, rng, replicates):
        xi = rng.standard_normal((replicates, SETTLING + self.experiment.order + self.samples))
        xi *= self.noise
        xi += forcing
        return lfilter([1.0], [1.0, *self.experiment.a], xi)[:, SETTLING:]


def over_time(period, first, length):
    """A periodic sequence from phase `first` on."""
    return np.resize(np.roll(period, -first), length)


def leaf_spring_grid():
    """Every cell of the scenario, border by border."""
    with SCENARIO.open("rb") as file:
        scenario = tomllib.load(file)
    system, sweep = scenario["system"], scenario["sweep"]
    linear = (tuple(system["a"]), tuple(system["b"]), tuple(system["interval"]))
    borders = [Border(b["name"], b["stiffness"], b.get("hardening", 0.0), b["friction"]) for b in scenario["border"]]
    experiments = [Experiment(*linear, border, points) for border in borders for points in sweep["points"]]
    return [Cell(*cell) for cell in itertools.product(experiments, sweep["noise"], sweep["samples"])]
