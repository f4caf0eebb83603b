"""What calls return: typed, framed, pickled, copied, shown."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import switchback as sb
from conftest import BENCH, LEAF_SPRING, QUICK, drive, machine


@pytest.fixture(scope="module")
def rig(frame: dict[str, np.ndarray]) -> sb.Rig:
    return sb.Rig.from_frame(frame, name="short")


@pytest.fixture(scope="module")
def identification(rig: sb.Rig) -> sb.Identification:
    return sb.identify(rig)


@pytest.fixture(scope="module")
def diagnosis(rig: sb.Rig) -> sb.Diagnosis:
    return sb.diagnose(rig)


@pytest.fixture(scope="module")
def study() -> sb.Study:
    return sb.study(QUICK)


def test_a_rig_tells_what_it_took(rig: sb.Rig, frame: dict[str, np.ndarray]) -> None:
    assert (rig.input, rig.output, rig.sample_time, rig.order) == ("travel [mm]", "force [N]", 0.01, None)
    fitted, held = rig.records
    assert (fitted.use, held.use, held.name) == ("fit", "holdout", "short-held-out")
    assert np.array_equal(np.concatenate([fitted.v, held.v]), frame["travel [mm]"])
    assert "held out: the last third of short" in rig.reported and "`holdout=0.3` or `holdout=NAME` changes it" in rig.reported
    assert "columns = {" in sb.Rig.read(BENCH).to_toml()


def test_an_identification_finds_the_machine(identification: sb.Identification) -> None:
    # y(t) = 0.6 y(t−1) + 0.4 u(t), u within ±6 on the interval: the direct term makes the delay −1.
    model = identification.model
    assert identification.method == "free" and model.delay == identification.delay
    assert model.sample_time == 0.01 and len(identification.a) == identification.order
    poles = np.roots(np.concatenate([[1.0], model.a]))
    assert np.min(np.abs(poles - 0.6)) < 0.05
    assert all(fit is not None and fit > 90 for fit in identification.fit_percent.values())
    assert identification.borders["ascending"] == identification.ascending
    assert all(point.se is not None for point in identification.descending)


def test_bode_is_the_response_of_the_difference_equation(identification: sb.Identification) -> None:
    model = identification.model
    found = model.bode([0.0, 5.0])
    assert found.response[0] == pytest.approx(model.b.sum() / (1 + model.a.sum()), rel=1e-12)
    # The slow way: the steady answer to a long sine, by the recursion itself.
    samples = np.arange(4000)
    u = np.exp(2j * np.pi * 5.0 * samples * model.sample_time)
    y = np.zeros(4000, dtype=complex)
    for t in range(20, 3980):
        past = sum(b * u[t - model.delay - i] for i, b in enumerate(model.b, 1))
        y[t] = past - sum(a * y[t - i] for i, a in enumerate(model.a, 1))
    assert found.response[1] == pytest.approx(y[3900] / u[3900], rel=1e-9)
    assert len(model.bode().frequency) == 200 and model.bode().frequency[-1] == pytest.approx(50.0)


def test_a_model_predicts_the_machine(identification: sb.Identification) -> None:
    v = drive(300, seed=9)
    y = machine(v)
    run = identification.simulate(v, y)
    assert run.fit_percent is not None and run.fit_percent > 90
    assert np.all(run.low[run.start :] <= run.y[run.start :]) and len(run.y) == 300
    gaps = y.copy()
    gaps[::7] = np.nan
    assert "missing in" in " ".join(identification.simulate(v, gaps).notes)


def test_a_diagnosis_in_objects(diagnosis: sb.Diagnosis) -> None:
    verdict = diagnosis.verdict
    assert verdict.status in ("none", "refit", "named", "class", "ambiguous", "shortlist", "unexplained")
    assert diagnosis.candidates[0].probability >= diagnosis.candidates[1].probability
    assert {place.axis for place in diagnosis.where} >= {"record", "v"}
    assert 0 <= diagnosis.gap.noise_floor < 1
    assert diagnosis.nominal is not None and diagnosis.nominal.order >= 1


def test_tables_are_frames(diagnosis: sb.Diagnosis, study: sb.Study) -> None:
    pytest.importorskip("pandas")
    pytest.importorskip("polars")
    tables: list[sb.Table[Any]] = [
        diagnosis.candidates,
        diagnosis.where,
        diagnosis.gap.per_record,
        study.summaries,
        study.cells,
        study.expectations,
    ]
    for table in tables:
        pandas, polars = table.to_pandas(), table.to_polars()
        assert len(pandas) == len(polars) == len(table) > 0
        assert list(pandas.columns) == polars.columns
        assert table._repr_html_().startswith("<table>")
    assert list(diagnosis.candidates.to_pandas()["effect"]) == [candidate.effect for candidate in diagnosis.candidates]
    assert diagnosis.candidates[:2][1] == diagnosis.candidates[1]


def test_a_study_in_objects(study: sb.Study) -> None:
    assert study.as_expected and study.name == "quick"
    row = next(row for row in study.summaries if row.method == "paper-descendant" and row.group == "a")
    assert row.verdict == "consistent" and row.sd_slope.low is not None and row.sd_slope.low < -0.5
    assert {cell.samples for cell in study.cells} == {300, 1000, 3000}


RESULTS = ["rig", "identification", "model", "diagnosis", "study", "simulation", "planted", "design", "table"]


@pytest.fixture
def results(rig: sb.Rig, identification: sb.Identification, diagnosis: sb.Diagnosis, study: sb.Study) -> dict[str, Any]:
    return {
        "rig": rig,
        "identification": identification,
        "model": identification.model,
        "diagnosis": diagnosis,
        "study": study,
        "simulation": identification.simulate(drive(100)),
        "planted": sb.plant(rig, "output_noise"),
        "design": sb.design(1, 4, (-1, 1), 100),
        "table": diagnosis.candidates,
    }


@pytest.mark.parametrize(
    "again", [copy.copy, copy.deepcopy, lambda x: pickle.loads(pickle.dumps(x))], ids=["copy", "deepcopy", "pickle"]
)
def test_copies_are_equal(results: dict[str, Any], again: Callable[[Any], Any]) -> None:
    for name, result in results.items():
        other = again(result)
        assert other == result and hash(other) == hash(result), name
        if isinstance(result, sb.Result):
            assert (other.words, other.files(), other.to_dict()) == (result.words, result.files(), result.to_dict())
    assert again(results["rig"]).reported == results["rig"].reported
    assert again(results["simulation"]).y.tolist() == results["simulation"].y.tolist()
    assert again(results["identification"]).simulate([0.0, 1.0, 2.0, 1.0]) == results["identification"].simulate(
        [0.0, 1.0, 2.0, 1.0]
    )
    assert again(results["planted"]).rig == results["planted"].rig


def test_notebooks_show_pages(results: dict[str, Any]) -> None:
    for name, result in results.items():
        assert not hasattr(result, "_repr_html_") or "<" in result._repr_html_(), name
    assert all(repr(result) for result in results.values())
    # Figures lie within the page, whatever lies beside it.
    page = results["diagnosis"]._repr_html_()
    assert page.startswith("<iframe srcdoc=") and "svg" in page and 'src="where.svg"' not in page


def test_files_of_others_are_not_replaced(identification: sb.Identification, tmp_path: Path) -> None:
    (tmp_path / "model.json").write_text("mine")
    with pytest.raises(sb.SwitchbackError, match="model.json"):
        identification.save(tmp_path)
    assert (tmp_path / "model.json").read_text() == "mine"
    identification.save(tmp_path, force=True)
    assert sb.Model.read(tmp_path / "model.json") == identification.model


def test_designed_experiments_from_memory(tmp_path: Path) -> None:
    plan = sb.design(1, 5, (-10, 10), 100, periods=30)
    inputs = plan.records
    frame = {
        "v": np.concatenate(list(inputs.values())),
        # The paper's system answers a sample later.
        "y": np.concatenate([np.append(0.0, machine(v, noise=0.01, seed=k)[:-1]) for k, v in enumerate(inputs.values())]),
        "run": np.repeat(list(inputs), [len(v) for v in inputs.values()]),
    }
    rig = sb.Rig.from_frame(
        frame, record="run", sample_time=0.01, order=1, interval=(-10, 10), roles=plan.roles, holdout=plan.holdout or None
    )
    found = sb.identify(rig)
    assert found.method in ("efficient", "joint") and found.a[0] == pytest.approx(-0.6, abs=0.01)


def test_figures(results: dict[str, Any]) -> None:
    pytest.importorskip("matplotlib").use("Agg")
    from matplotlib import pyplot

    kinds = {
        "identification": ["borders", "loop"],
        "diagnosis": ["where", "candidates", "loop", "borders"],
        "study": ["a", "b", "ascending"],
    }
    for name, result in results.items():
        for kind in kinds.get(name, []):
            axes = result.plot(kind)
            assert axes.get_xlabel() and axes.has_data()
            pyplot.close(axes.figure)
    for axes in (results["simulation"].plot(), results["model"].plot(), results["model"].bode().plot()[0]):
        assert axes.has_data()
    pyplot.close("all")
    with pytest.raises(sb.SwitchbackError, match="there is no plot `loops`"):
        results["diagnosis"].plot("loops")


def test_the_shipped_rig_reads() -> None:
    rig = sb.Rig.read(LEAF_SPRING)
    assert rig.order == 2 and {record.role for record in rig.records} >= {"descendant", "ascendant"}
