"""The protocol `switchback/method/1` for estimators in Python: ``serve(function)``.

``function`` is called with one :class:`Request` and returns the estimates in the order of ``request.parameters``, or a pair of estimates and standard
errors. Whatever it raises is the reason why there is no estimate. What it prints goes to standard error, where it does no harm.
"""

from __future__ import annotations

import json
import mmap
import os
import sys
from typing import Any, Callable

import numpy as np

PROTOCOL = "switchback/method/1"


class Experiment:
    """One pulse experiment: arrays ``v`` and ``y`` that cannot be changed, ``levels``, ``satellite``, ``lead``."""

    __slots__ = ("name", "levels", "satellite", "lead", "v", "y")

    def __init__(self, known: dict[str, Any], v: np.ndarray) -> None:
        self.name, self.levels, self.satellite = known["name"], np.asarray(known["levels"]), known["satellite"]
        self.lead, self.v, self.y = known["lead"], v, v


class Request:
    """One replicate of a cell."""

    __slots__ = ("order", "points", "samples", "interval", "parameters", "replicate", "antithetic", "descendant", "ascendant", "cell")

    def __init__(self, known: dict[str, Any], inputs: list[np.ndarray]) -> None:
        for name in ("cell", "order", "points", "samples", "interval", "parameters"):
            setattr(self, name, known[name])
        self.descendant, self.ascendant = (Experiment(e, v) for e, v in zip(known["experiments"], inputs))


class Block:
    """The numbers of a file, as it grows."""

    def __init__(self) -> None:
        self.path, self.file, self.numbers = None, None, np.empty(0)

    def __call__(self, path: str, stored: dict[str, int]) -> np.ndarray:
        end = stored["at"] + stored["count"]
        if path != self.path:
            self.path, self.file, self.numbers = path, open(path, "rb"), np.empty(0)
        if end > self.numbers.size:
            size = os.fstat(self.file.fileno()).st_size
            self.numbers = np.frombuffer(mmap.mmap(self.file.fileno(), size, access=mmap.ACCESS_READ), dtype="<f8")
        return self.numbers[stored["at"] : end]


def serve(function: Callable[[Request], Any], version: str = "") -> None:
    """Answers requests until there are no more."""
    # Only answers may go where they are read: what libraries print goes to standard error.
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    requests = sys.stdin.buffer
    greeting = json.loads(requests.readline() or b"{}")
    if greeting.get("schema") != PROTOCOL:
        sys.exit(f"the program speaks {greeting.get('schema')}, and not {PROTOCOL}")
    answers.write(json.dumps({"schema": PROTOCOL, "version": version}) + "\n")
    answers.flush()
    block, common, request = Block(), b"", None
    for line in requests:
        # Behind `cell` all requests of a cell are the same: they are read once.
        begin = line.index(b'"cell":')
        head = json.loads(line[:begin].rstrip(b",") + b"}")
        if line[begin:] != common:
            common = line[begin:]
            known = json.loads(b"{" + common)
            path = known["block"]
            # Inputs stay while outputs come and go.
            request = Request(known, [block(path, e["v"]).copy() for e in known["experiments"]])
        request.replicate, request.antithetic = head["replicate"], head["antithetic"]
        request.descendant.y, request.ascendant.y = (block(path, y) for y in head["y"])
        answers.write(_answer(function, request, head["id"]))
        answers.flush()


def _answer(function: Callable[[Request], Any], request: Request, number: int) -> str:
    try:
        found = function(request)
        estimate, se = found if isinstance(found, tuple) and len(found) == 2 and np.ndim(found[0]) == 1 else (found, None)
        answer = {"id": number, "estimate": np.asarray(estimate, dtype=float).tolist()}
        if se is not None:
            answer["se"] = np.asarray(se, dtype=float).tolist()
    except Exception as error:
        answer = {"id": number, "failed": f"{type(error).__name__}: {error}"}
    return json.dumps(answer) + "\n"
