"""The estimator keeps the conventions of scikit-learn."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

sklearn = pytest.importorskip("sklearn")

import switchback as sb  # noqa: E402
from conftest import drive, machine  # noqa: E402
from sklearn.base import clone  # noqa: E402
from sklearn.exceptions import NotFittedError  # noqa: E402
from sklearn.model_selection import GridSearchCV, TimeSeriesSplit  # noqa: E402
from sklearn.pipeline import make_pipeline  # noqa: E402
from sklearn.preprocessing import StandardScaler  # noqa: E402
from sklearn.utils import estimator_checks  # noqa: E402

V = drive(900, seed=4)
Y = machine(V, noise=0.01)


def test_a_fit_finds_the_machine() -> None:
    found = sb.SwitchedHysteresis(order=1, points=6).fit(V, Y)
    assert found.a_[0] == pytest.approx(-0.6, abs=0.02)
    assert found.n_features_in_ == 1
    fresh = drive(400, seed=8)
    assert found.score(fresh, machine(fresh)) > 0.98
    assert found.predict(fresh).shape == (400,)
    assert found.model_.order == 1


def test_both_shapes_are_one_and_the_same() -> None:
    one, two = sb.SwitchedHysteresis(1, 4).fit(V, Y), sb.SwitchedHysteresis(1, 4).fit(V.reshape(-1, 1), Y)
    assert one.model_ == two.model_
    assert np.array_equal(one.predict(V), two.predict(V.reshape(-1, 1)))


def test_parameters_are_what_was_given() -> None:
    found = sb.SwitchedHysteresis(order=3, causal=False)
    assert found.get_params() == {"order": 3, "points": 8, "delay": None, "causal": False, "sample_time": 1.0, "threads": None}
    assert found.set_params(order=1, points=4).get_params()["points"] == 4
    assert clone(found).get_params() == found.get_params()
    assert "order=1" in repr(found)


def test_a_fitted_one_is_pickled_and_cloned_without_its_fit() -> None:
    found = sb.SwitchedHysteresis(1, 4).fit(V, Y)
    again = pickle.loads(pickle.dumps(found))
    assert np.array_equal(again.predict(V), found.predict(V))
    with pytest.raises(NotFittedError):
        clone(found).predict(V)


def test_a_grid_search_over_time_prefers_a_border_that_bends() -> None:
    search = GridSearchCV(sb.SwitchedHysteresis(threads=1), {"order": [1, 2], "points": [2, 6]}, cv=TimeSeriesSplit(2))
    bent = np.sign(V) * V**2 / 10
    search.fit(V.reshape(-1, 1), machine(bent, noise=0.01))
    assert search.best_params_["points"] == 6 and search.best_score_ > 0.95


def test_in_a_pipeline() -> None:
    found = make_pipeline(StandardScaler(), sb.SwitchedHysteresis(1, 4)).fit(V.reshape(-1, 1), Y)
    assert found.score(V.reshape(-1, 1), Y) > 0.98


@pytest.mark.parametrize(
    "check",
    [
        "check_no_attributes_set_in_init",
        "check_get_params_invariance",
        "check_set_params",
        "check_parameters_default_constructible",
        "check_estimators_unfitted",
    ],
)
def test_checks_of_scikit_learn(check: str) -> None:
    getattr(estimator_checks, check)("SwitchedHysteresis", sb.SwitchedHysteresis())


@pytest.mark.parametrize(
    ("X", "y", "words"),
    [
        (V, Y[:5], "inconsistent numbers of samples"),
        (np.column_stack([V, V]), Y, "2 features"),
        (np.where(V > 9, np.nan, V), Y, "NaN"),
        (V, np.where(Y > 1, np.inf, Y), "infinity"),
        (V[:3], Y[:3], "samples"),
        (np.zeros(900), Y, "mov"),
        ([], [], "0 sample"),
        (["a"] * 900, Y, "convert"),
    ],
)
def test_bad_records(X: object, y: object, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        sb.SwitchedHysteresis().fit(X, y)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "params", [{"order": 0}, {"points": 1}, {"order": 1.5}, {"threads": 0}, {"sample_time": 0.0}, {"delay": -5}]
)
def test_bad_parameters_are_told_by_fit(params: dict[str, float]) -> None:
    with pytest.raises(ValueError, match=next(iter(params))):
        sb.SwitchedHysteresis(**params).fit(V, Y)  # type: ignore[arg-type]
