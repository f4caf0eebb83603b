"""A joint of MuJoCo beside the machine that it stands for: which attributes are off, and to what they must be set."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import switchback as sb

mujoco = pytest.importorskip("mujoco", reason="SKIPPED: MuJoCo is not installed (pip install mujoco)")

RATE, SAMPLES, REACH = 200.0, 5000, 1.5
MODEL = """
<mujoco>
  <option gravity="0 0 0"/>
  <worldbody><body>
    <inertial pos="0 0 0" mass="1" diaginertia="1e-9 1e-9 1e-9"/>
    <joint name="joint" axis="0 1 0" stiffness="{stiffness}" damping="{damping}" armature="{armature}" frictionloss="{frictionloss}"/>
  </body></worldbody>
</mujoco>
"""
OFF = ("frictionloss", "damping", "armature", "delay", "all")


def motion(rng: np.random.Generator) -> np.ndarray:
    """Angle, speed and acceleration: ten sines between 0.1 and 4 Hz."""
    t = np.arange(SAMPLES) / RATE
    f = 0.1 * 40 ** ((np.arange(10) + rng.uniform(size=10)) / 10)
    w, phase = 2 * np.pi * f[:, None], rng.uniform(0, 2 * np.pi, (10, 1))
    x = f[:, None] ** -0.7 * np.stack([np.sin(w * t + phase), w * np.cos(w * t + phase), -(w**2) * np.sin(w * t + phase)])
    q = x.sum(axis=1)
    moved: np.ndarray = q * REACH / np.abs(q[0]).max()
    return moved


def torque(moved: np.ndarray, attributes: dict[str, float]) -> np.ndarray:
    """The torque that moves the joint so."""
    model = mujoco.MjModel.from_xml_string(MODEL.format(**attributes))
    data, found = mujoco.MjData(model), []
    for data.qpos[0], data.qvel[0], data.qacc[0] in moved.T:
        mujoco.mj_inverse(model, data)
        found.append(data.qfrc_inverse[0])
    return np.array(found)


def joint(seed: int) -> tuple[sb.Rig, dict[str, tuple[float, float]]]:
    """A machine with the predictions of a simulator, and each attribute that is off with both values."""
    rng, off = np.random.default_rng(seed), OFF[seed % len(OFF)]
    ranges = {"stiffness": (0.5, 3), "frictionloss": (0.3, 1), "damping": (0.05, 0.3), "armature": (0.01, 0.05)}
    simulator = {name: rng.uniform(*ends) for name, ends in ranges.items()}
    real = dict(simulator)
    for name in OFF[:3]:
        real[name] *= rng.uniform(0.65, 0.85) ** rng.choice([-1, 1]) if off in (name, "all") else 1
    late = int(rng.integers(1, 5)) if off in ("delay", "all") else 0
    moved = motion(rng)
    y, y_sim = torque(moved, real), torque(moved, simulator)
    y = np.concatenate([np.full(late, y[0]), y[: SAMPLES - late]])
    y += rng.uniform(0.003, 0.02) * y.std() * rng.standard_normal(SAMPLES)
    frame = {"time": np.arange(SAMPLES) / RATE, "angle [rad]": moved[0], "torque [Nm]": y}
    wanted = {name: (simulator[name], real[name]) for name in simulator if simulator[name] != real[name]}
    if late:
        wanted["delay"] = (-late / RATE, 0.0)
    return sb.Rig.from_frame(frame, name="joint").with_y_sim(y_sim), wanted


# Friction is a soft constraint in MuJoCo, whose force follows the velocity to come; here it follows the velocity and a share of the acceleration.
SOFT = 0.1
# MuJoCo derives the speed at which friction slips from both: it differs where one of them does.
SLIPS_BY = {"armature", "frictionloss"}


def differing(rig: sb.Rig, wanted: dict[str, tuple[float, float]]) -> dict[str, Any]:
    """Rows that differ, by attribute, without what follows from another attribute that is off."""
    rows: list[Any] = [row for row in sb.diagnose(rig).differences if row.differs]
    found = {row.attribute or row.what: row for row in rows}
    if SLIPS_BY & set(wanted):
        found.pop("slip_speed", None)
    return found


@pytest.mark.parametrize("seed", range(len(OFF)))
def test_the_attributes_that_are_off_are_found(seed: int) -> None:
    rig, wanted = joint(seed)
    found = differing(rig, wanted)
    assert set(found) == set(wanted)
    for name, (simulator, real) in wanted.items():
        row = found[name]
        assert abs((row.in_b - row.in_a) - (real - simulator)) < SOFT * abs(real - simulator), row


if __name__ == "__main__":
    right = inside = values = 0
    for number in range(20):
        rig, wanted = joint(number)
        found = differing(rig, wanted)
        right += set(found) == set(wanted)
        for name in set(found) & set(wanted):
            row, (simulator, real) = found[name], wanted[name]
            values += 1
            inside += abs((row.in_b - row.in_a) - (real - simulator)) < 1.96 * row.se
        print(OFF[number % 5], sorted(found), sorted(wanted), flush=True)
    print(f"right rows in {right} of 20, values in their intervals {inside} of {values}")
