"""Checks the tools against Switchback, times them beside it, and writes reports/speed/."""

import argparse
import os
import sys
from pathlib import Path

# Before NumPy is imported: its BLAS reads these once.
THREADS = ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMEXPR_NUM_THREADS"]
os.environ |= dict.fromkeys(THREADS, "1")

import check
import measure
import report
import switchback
from grid import ROOT, leaf_spring_grid
from tools.numpy_batched import NumpyBatched, NumpyEinsum
from tools.numpy_expert import NumpyExpert
from tools.numpy_lstsq import NumpyLstsq
from tools.octave_arx import OctaveArx
from tools.sippy_arx import SippyArx
from tools.sysidentpy_least_squares import SysidentpyLeastSquares
from tools.tool import Unavailable

TOOLS = [NumpyLstsq, NumpyBatched, NumpyEinsum, NumpyExpert, SippyArx, SysidentpyLeastSquares, OctaveArx]


def main():
    arguments = parse()
    cells = leaf_spring_grid()
    tools, missing = available()
    say(f"checking {len(tools)} tools on one of Switchback's replicates")
    differences = check.largest_differences(tools, switchback.replicate_zero(cells))
    for name, difference in differences.items():
        say(f"  {name}: {difference:.1e}")
    if arguments.check_only:
        return
    grid = switchback.Grid(arguments.replicates)
    times = measure.alternate(tools, grid, cells, arguments.rounds, say)
    setting = {
        "command": " ".join(["benches/peers/run.sh", *sys.argv[1:]]),
        "rounds": arguments.rounds,
        "cells": len(cells),
        "grid_samples": sum(cell.samples for cell in cells),
        "slow_check_samples": check.SLOW_SAMPLES,
        "switchback": grid.how,
    }
    page = report.results([(tool, times[tool.name], differences[tool.name]) for tool in tools], missing, setting)
    report.write(page, arguments.out)
    print(report.table(page))


def parse():
    parser = argparse.ArgumentParser(prog="benches/peers/run.sh", description=__doc__)
    parser.add_argument("--rounds", type=int, default=5, help="measurements of every tool (5)")
    parser.add_argument("--replicates", type=int, default=9600, help="replicates of one of Switchback's runs (9600)")
    parser.add_argument("--check-only", action="store_true", help="compare the estimates and stop")
    parser.add_argument("--out", type=Path, default=ROOT / "reports" / "speed", help="where the table goes")
    return parser.parse_args()


def available():
    """The tools that can run here; for the others, loudly, why not."""
    tools, missing = [], {}
    for kind in TOOLS:
        try:
            tools.append(kind())
        except Unavailable as reason:
            missing[kind.name] = str(reason)
            say(f"NOT AVAILABLE: {kind.name}: {reason}")
    return tools, missing


def say(message):
    print(message, file=sys.stderr, flush=True)


if __name__ == "__main__":
    try:
        main()
    except check.Disagreement as error:
        sys.exit(f"the estimates differ, so no table is written: {error}")
