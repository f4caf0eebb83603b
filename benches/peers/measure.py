"""Times, in turns: every measurement of a tool follows one of Switchback, so that a busy machine slows both."""

from dataclasses import dataclass, field
from itertools import groupby

import numpy as np

SEED = 1


@dataclass
class Times:
    """Processor seconds of one replicate of the whole grid, and Switchback's measured just before, a pair a round."""

    tool: list = field(default_factory=list)
    switchback: list = field(default_factory=list)

    @property
    def ratios(self):
        return [tool / ours for tool, ours in zip(self.tool, self.switchback)]


def alternate(tools, switchback, cells, rounds, say):
    """The times of every tool, by name."""
    for cell in cells:
        cell.prepare()
    rng = np.random.Generator(np.random.SFC64(SEED))
    times = {tool.name: Times() for tool in tools}
    for turn in range(rounds):
        for tool in tools:
            ours, theirs = switchback.seconds(), grid_seconds(tool, cells, rng)
            times[tool.name].switchback.append(ours)
            times[tool.name].tool.append(theirs)
            say(f"  round {turn + 1} of {rounds}: {tool.name} {theirs:.3g} s, Switchback {ours:.3g} s a replicate")
    return times


def grid_seconds(tool, cells, rng):
    """Seconds of one replicate of every cell; cells too large for a slow tool take its time a sample at the largest."""
    if tool.largest_samples is None:
        return sum(tool.seconds(cell, rng) for cell in cells)
    timed = {work(cell): tool.seconds(cell, rng) for cell in sample_of(cells, tool.largest_samples)}
    total = 0.0
    for cell in cells:
        samples = min(cell.samples, tool.largest_samples)
        total += timed[cell.experiment.points, samples] * cell.samples / samples
    return total


def work(cell):
    """What the time depends on: the values of the border and of the noise level do not change the work."""
    return cell.experiment.points, cell.samples


def sample_of(cells, largest_samples):
    """One cell of every kind of work, up to so many samples."""
    affordable = sorted((cell for cell in cells if cell.samples <= largest_samples), key=work)
    return [next(same) for _, same in groupby(affordable, key=work)]
