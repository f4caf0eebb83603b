"""What a diagnosis from Python costs over the same from the command line: ``python overhead.py [PAIRS]``, where the wheel is installed.

Both are run on one thread, in turn, and the best of each is taken. Times are seconds of processor time, which what else the machine does
hardly touches. Those of the command line are of all of the program, those of Python of the call in an interpreter that runs already.
"""

from __future__ import annotations

import resource
import sys
import tempfile
from pathlib import Path

import switchback as sb
from conftest import BENCH, Program

# What may be more: a share of the program's time, or so many seconds where that is more.
SHARE, SECONDS = 0.02, 0.010


def processor_seconds(who: int) -> float:
    """Of this process, or of its children that have ended."""
    usage = resource.getrusage(who)
    return usage.ru_utime + usage.ru_stime


def measure(program: Program, pairs: int) -> tuple[list[float], list[float]]:
    """Seconds of diagnoses of the bench: from Python, and from the command line."""
    rig = sb.Rig.read(BENCH)
    ours, theirs = [], []
    for _ in range(pairs):
        before = processor_seconds(resource.RUSAGE_SELF)
        sb.diagnose(rig, threads=1).to_json()
        ours.append(processor_seconds(resource.RUSAGE_SELF) - before)
        before = processor_seconds(resource.RUSAGE_CHILDREN)
        program.json("gap", BENCH, "--threads", 1)
        theirs.append(processor_seconds(resource.RUSAGE_CHILDREN) - before)
    return ours, theirs


def is_little(ours: list[float], theirs: list[float]) -> bool:
    """Whether the call costs no more than is allowed."""
    return min(ours) - min(theirs) <= max(SHARE * min(theirs), SECONDS)


def main() -> None:
    pairs = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    with tempfile.TemporaryDirectory() as folder:
        ours, theirs = measure(Program(Path(folder)), pairs)
    more = 1e3 * (min(ours) - min(theirs))
    print(f"a diagnosis of {BENCH.name}, one thread, best of {pairs}: {min(theirs):.3f} s of the program, ", end="")
    print(f"{min(ours):.3f} s of the call from Python, {more:+.0f} ms ({0.1 * more / min(theirs):+.2f} %)")
    sys.exit(not is_little(ours, theirs))


if __name__ == "__main__":
    main()
