"""Functions as estimators of a study."""

from __future__ import annotations

import json

import numpy as np
import pytest
import switchback as sb

SCENARIO = {
    "study": "consistency",
    "question": "Is it consistent?",
    "seed": 3,
    "replicates": 64,
    "system": {"a": [-0.7], "b": [0.3], "interval": [-1.0, 1.0]},
    "border": [{"name": "spring", "kind": "leaf_spring", "stiffness": 1.0, "friction": 0.3}],
    "sweep": {"noise": [0.1], "samples": [500], "points": [3], "methods": ["joint"]},
}


def least_squares(records: sb.MethodRecords) -> np.ndarray:
    """What `joint` does, for order 1."""
    half, blocks, right = records.points - 1, [], []
    for k, e in enumerate((records.descendant, records.ascendant)):
        u = np.zeros((e.v.size, 1 + 2 * half))
        u[:, 0] = e.v == (e.satellite if k == 0 else e.levels[0])
        for j in range(1, records.points):
            u[:, k * half + j] = e.v == e.levels[j]
        rows = slice(e.lead, e.lead + records.samples)
        before = slice(rows.start - 1, rows.stop - 1)
        blocks.append(np.column_stack([-e.y[before], u[before], np.ones(records.samples)]))
        right.append(e.y[rows])
    a, b, *mu, kappa = np.linalg.lstsq(np.vstack(blocks), np.concatenate(right), rcond=None)[0]
    low, w = kappa / b, np.array(mu) / b
    return np.concatenate([[a, b, low], low + w[:half], [low + 1.0], low + w[half:]])


def test_a_function_is_judged_beside_our_methods_and_gives_their_figures() -> None:
    study = sb.study(SCENARIO, methods={"mine": least_squares}, progress=False)
    ours, mine = ([cell for cell in study.cells if cell.method == method] for method in ("joint", "mine"))
    assert len(ours) == len(mine) == 8
    for one, other in zip(ours, mine):
        assert one.name == other.name
        np.testing.assert_allclose(one.bias, other.bias, rtol=0, atol=1e-7)
        np.testing.assert_allclose(one.sd, other.sd, rtol=1e-4)


def test_any_number_of_threads_gives_the_same_bytes() -> None:
    one, four = (sb.study(SCENARIO, methods={"mine": least_squares}, threads=k, progress=False).to_json() for k in (1, 4))
    assert one == four


def test_what_a_function_does_wrong_fails_its_replicate() -> None:
    def often_wrong(records: sb.MethodRecords):
        if records.replicate == 3:
            raise ValueError("not today")
        if records.replicate == 5:
            return [1.0]
        if records.replicate == 7:
            return {"a1": 1.0}
        if records.replicate == 9:
            return np.full(len(records.parameters), np.nan)
        found = least_squares(records)
        return dict(zip(records.parameters, found)), dict(zip(records.parameters, 0 * found + 0.1))

    study = sb.study(SCENARIO, methods={"mine": often_wrong}, progress=False)
    failures = json.loads(study.to_json())["cells"][1]["failures"]
    assert failures["replicates"] == [3, 5, 7, 9]
    for reason, words in zip(failures["reasons"], ["ValueError: not today", "1 estimates of 8", "KeyError", "no number"]):
        assert words in reason


def test_arrays_are_read_only_and_say_nothing_of_the_system() -> None:
    def curious(records: sb.MethodRecords):
        with pytest.raises(ValueError):
            records.descendant.y[0] = 1.0
        assert not {"noise", "a", "b", "truth"} & set(vars(records))
        return least_squares(records)

    study = sb.study(SCENARIO, methods={"mine": curious}, progress=False)
    assert [cell["failures"]["count"] for cell in json.loads(study.to_json())["cells"]] == [0, 0]


@pytest.mark.parametrize("name", ["joint", "a b", "../x", ""])
def test_other_names_are_refused(name: str) -> None:
    with pytest.raises(sb.SwitchbackError, match="name of a method"):
        sb.study(SCENARIO, methods={name: least_squares}, progress=False)


def test_commands_are_left_to_the_command_line() -> None:
    scenario = {**SCENARIO, "method": [{"name": "theirs", "command": ["python", "x.py"]}]}
    with pytest.raises(sb.SwitchbackError, match="only the command line"):
        sb.study(scenario, progress=False)
