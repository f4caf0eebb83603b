"""What asking an estimator of others costs beside its own time: ``python method_overhead.py [RECORDS]``, where the wheel is installed.

A study of one cell (N = 1000, order 2, m = 4) asks an estimator that does nothing, once as a function of this interpreter and once as a command that
speaks the protocol with ``estimators/switchback_method.py``. Times are microseconds of processor time an answer, which what else the machine does
hardly touches: of the whole study with all its processes, less those of the same study with two replicates, less what the estimator took, less RECORDS:
what the study takes by itself for noise, records and sums of controls, as ``cargo test -p switchback --test all -- --ignored overhead_of_records_alone``
measures it with an estimator in the program. It is run where RECORDS is not given. Ends with 1 where asking costs more than it may.
"""

from __future__ import annotations

import json
import re
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
import switchback as sb
from conftest import ROOT, program_path

# Microseconds that asking may cost.
FUNCTION, COMMAND = 20.0, 50.0

PARAMETERS, REPLICATES = 12, 3000


def scenario(replicates: int) -> dict[str, Any]:
    return {
        "study": "consistency",
        "question": "What does asking cost?",
        "seed": 1,
        "replicates": replicates,
        "system": {"a": [-1.2, 0.45], "b": [0.15, 0.10], "interval": [-40.0, 40.0]},
        "border": [{"name": "spring", "kind": "leaf_spring", "stiffness": 0.12, "hardening": 6e-5, "friction": 2.0}],
        "sweep": {"noise": [0.2], "samples": [1000], "points": [4], "methods": ["memoryless"]},
    }


class Nothing:
    """An estimator that does nothing, and knows how long."""

    def __init__(self) -> None:
        self.answer, self.calls, self.own = np.zeros(PARAMETERS), 0, 0.0

    def __call__(self, _: Any) -> np.ndarray:
        begun = time.process_time()
        self.calls += 1
        answer = self.answer
        self.own += time.process_time() - begun
        return answer


def of_function(replicates: int) -> float:
    """Seconds of this process without those of the estimator."""
    nothing = Nothing()
    begun = time.process_time()
    sb.study(scenario(replicates), methods={"nothing": nothing}, threads=1, progress=False)
    return time.process_time() - begun - nothing.own


def text(replicates: int, command: list[str]) -> str:
    known = scenario(replicates)
    border, system, sweep = known["border"][0], known["system"], known["sweep"]
    lines = [f"{key} = {json.dumps(known[key])}" for key in ("study", "question", "seed", "replicates")]
    for name, table in (("[system]", system), ("[[border]]", border), ("[[method]]", {"name": "nothing", "command": command, "workers": 1}), ("[sweep]", sweep)):
        lines += [name, *(f"{key} = {json.dumps(value)}" for key, value in table.items())]
    return "\n".join(lines) + "\n"


def of_command(folder: Path, replicates: int) -> tuple[float, float, float]:
    """Seconds of all processes, those of the command, and those of the estimator."""
    (folder / "study.toml").write_text(text(replicates, [sys.executable, str(Path(__file__).resolve()), "answer", str(folder / "times")]))
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    arguments = [program_path(), "study.toml", "--threads", "1", "--quiet", "--out", "out", "--force"]
    subprocess.run(arguments, cwd=folder, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    times = json.loads((folder / "times").read_text())
    whole = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return whole, times["process"], times["own"]


def answer(times: Path) -> None:
    """The other end: answers, and writes down how long it took whenever a hundred more were answered."""
    sys.path.insert(0, str(ROOT / "estimators"))
    from switchback_method import serve

    nothing = Nothing()

    def estimate(request: Any) -> np.ndarray:
        found = nothing(request)
        if nothing.calls % 100 == 0 or nothing.calls <= 4:
            times.write_text(json.dumps({"process": time.process_time(), "own": nothing.own}))
        return found

    serve(estimate, version="1")


def of_records() -> float:
    """Microseconds of an answer without asking."""
    test = ["cargo", "test", "--locked", "--quiet", "-p", "switchback", "--test", "all", "--"]
    test += ["--ignored", "--nocapture", "overhead_of_records_alone"]
    printed = subprocess.run(test, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    found = re.search(r"([0-9.]+) us an answer", printed)
    assert found, printed
    return float(found[1])


def measure(replicates: int) -> dict[str, float]:
    """Microseconds an answer, each replicate being two with its antithetic partner."""
    answers = 2 * (replicates - 2)
    with tempfile.TemporaryDirectory() as place:
        few, many = (of_command(Path(place), n) for n in (2, replicates))
    whole, process, own = (1e6 * (b - a) / answers for a, b in zip(few, many))
    short, long = (of_function(n) for n in (2, replicates))
    return {"function": 1e6 * (long - short) / answers, "command": whole - own, "of which in the command": process - own}


def main() -> None:
    if sys.argv[1:2] == ["answer"]:
        answer(Path(sys.argv[2]))
        return
    records = float(sys.argv[1]) if len(sys.argv) > 1 else of_records()
    found = measure(REPLICATES)
    function, command = found["function"] - records, found["command"] - records
    print(f"microseconds an answer: records {records:.1f}; beside them a function {function:.1f} (at most {FUNCTION:.0f}), ", end="")
    print(f"a command {command:.1f} (at most {COMMAND:.0f}), {found['of which in the command']:.1f} of it in the command itself")
    sys.exit(function > FUNCTION or command > COMMAND)


if __name__ == "__main__":
    main()
