"""A call: the interpreter goes on meanwhile, Ctrl-C stops it, progress is reported, and it costs next to nothing."""

from __future__ import annotations

import concurrent.futures
import io
import os
import signal
import sys
import threading
import time
from pathlib import Path

import numpy as np
import overhead
import pytest
import switchback as sb
from conftest import BENCH, QUICK, Program
from switchback import _native


@pytest.fixture(scope="module")
def bench() -> sb.Rig:
    return sb.Rig.read(BENCH)


def workers() -> int:
    """Threads of calls that are still at work."""

    def name(task: Path) -> str:
        try:
            return (task / "comm").read_text().strip()
        except (FileNotFoundError, ProcessLookupError):
            return ""  # It ended since it was listed.

    return [name(task) for task in Path("/proc/self/task").iterdir()].count("switchback")


LONG_STUDY = {"replicates": 10_000_000}


def long_study() -> sb.Study:
    tomllib = pytest.importorskip("tomllib")
    return sb.study({**tomllib.loads(QUICK.read_text()), **LONG_STUDY}, yes=True)


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="counts threads in /proc")
@pytest.mark.parametrize("what", ["identify", "diagnose", "study"])
def test_ctrl_c_stops_within_a_second_and_leaves_nothing_behind(what: str, bench: sb.Rig) -> None:
    calls = {"identify": lambda: sb.identify(bench), "diagnose": lambda: sb.diagnose(bench), "study": long_study}
    pressed = []

    def press() -> None:
        pressed.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(0.4, press)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        calls[what]()
    assert time.monotonic() - pressed[0] < 1.0
    # The work gives up as soon as the piece running is done.
    end = time.monotonic() + 60
    while workers() and time.monotonic() < end:
        time.sleep(0.05)
    assert workers() == 0
    # The next call knows nothing of it.
    assert sb.Rig.read(BENCH) == bench
    assert sb.study(QUICK).as_expected


def test_the_interpreter_goes_on_meanwhile(bench: sb.Rig) -> None:
    ticks = []
    is_done = threading.Event()

    def tick() -> None:
        while not is_done.is_set():
            ticks.append(time.monotonic())
            time.sleep(0.01)

    thread = threading.Thread(target=tick)
    thread.start()
    begun = time.monotonic()
    sb.identify(bench, "linear-arx")
    ended = time.monotonic()
    is_done.set()
    thread.join()
    during = [tick for tick in ticks if begun < tick < ended]
    # Were the lock held, there would be none.
    assert len(during) > (ended - begun) / 0.01 / 20


def test_calls_from_several_threads_give_the_same(bench: sb.Rig) -> None:
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        found = list(pool.map(lambda _: sb.identify(bench, "linear-arx", threads=1).to_json(), range(4)))
    assert len(set(found)) == 1


def test_an_error_in_a_thread_is_raised_there(frame: dict[str, np.ndarray]) -> None:
    rig = sb.Rig.from_frame(frame)
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        future = pool.submit(sb.identify, rig, "paper-descendant")
        with pytest.raises(sb.SwitchbackError):
            future.result()


def test_progress_is_told_by_stage(bench: sb.Rig) -> None:
    heard: list[tuple[str, int, int]] = []
    _native.identify(bench._records, {}, lambda *step: heard.append(step))
    assert {stage for stage, _, _ in heard} & {"identifying", "comparing with other models"}
    assert all(0 <= done <= found for _, done, found in heard)


def test_progress_is_drawn_where_it_is_asked_for(bench: sb.Rig, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("tqdm")
    stderr = io.StringIO()
    monkeypatch.setattr(sys, "stderr", stderr)
    sb.identify(bench, "memoryless", progress=True)
    shown = stderr.getvalue()
    sb.identify(bench, "memoryless", progress=False)
    sb.identify(bench, "memoryless")
    assert shown and stderr.getvalue() == shown


def test_what_a_listener_raises_stops_the_call(bench: sb.Rig) -> None:
    def refuse(stage: str, done: int, found: int) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        _native.identify(bench._records, {}, refuse)


def test_a_call_costs_no_more_than_the_program(program: Program) -> None:
    ours, theirs = overhead.measure(program, 3)
    assert overhead.is_little(ours, theirs), (ours, theirs)
