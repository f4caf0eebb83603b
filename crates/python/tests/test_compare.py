"""What differs between a machine and a model, a simulator, or records of another day."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import switchback as sb
from conftest import drive, machine

RATE = 100.0


def rig_of(y: np.ndarray, v: np.ndarray, name: str) -> sb.Rig:
    frame = {"time": np.arange(len(v)) / RATE, "travel [mm]": v, "force [N]": y}
    return sb.Rig.from_frame(frame, name=name)


@pytest.fixture(scope="module")
def v() -> np.ndarray:
    return drive(1500)


def test_a_lower_gain_of_a_simulator_is_the_one_difference(v: np.ndarray) -> None:
    y = machine(v, noise=0.02)
    rows = sb.compare(0.8 * machine(v), rig_of(y, v, "machine"))
    assert rows[0].what == "gain" and rows[0].differs and not any(row.differs for row in rows[1:])
    assert abs(rows[0].in_b / rows[0].in_a - 1.25) < 0.01 and rows[0].probability > 0.99
    frame = rows.to_pandas()
    assert list(frame["what"]) == [row.what for row in rows] and {"in_a", "in_b", "se", "closure"} <= set(frame.columns)


def test_records_of_two_days_and_a_model_of_one_are_compared(v: np.ndarray, tmp_path: Path) -> None:
    monday = rig_of(machine(v, noise=0.02), v, "monday")
    tuesday = rig_of(machine(v, noise=0.02, seed=1) + 2.0, v, "tuesday")
    rows = sb.compare(monday, tuesday)
    assert rows[0].what == "offset" and abs(rows[0].in_b - rows[0].in_a - 2.0) < 0.1
    assert sb.diagnose(tuesday, sb.identify(monday)).differences == sb.compare(sb.identify(monday), tuesday)
    assert not any(row.differs for row in sb.compare(monday, monday))


def test_what_cannot_be_compared_is_refused(v: np.ndarray) -> None:
    rig = rig_of(machine(v), v, "machine")
    with pytest.raises(sb.SwitchbackError, match="cannot be read"):
        sb.compare("missing.json", rig)
    with pytest.raises(sb.SwitchbackError):
        sb.compare(np.ones(3), rig)
