"""Whatever is given is taken, or refused with what is wrong and what to do about it; nothing else is raised."""

from __future__ import annotations

import datetime
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import switchback as sb
from conftest import QUICK

Frame = dict[str, np.ndarray]


def refused(words: str, call: Any, *arguments: Any, **options: Any) -> str:
    with pytest.raises(sb.SwitchbackError) as caught:
        call(*arguments, **options)
    assert words in str(caught.value), str(caught.value)
    return str(caught.value)


@pytest.fixture
def v(frame: Frame) -> np.ndarray:
    return frame["travel [mm]"].copy()


@pytest.fixture
def y(frame: Frame) -> np.ndarray:
    return frame["force [N]"].copy()


def test_what_is_no_frame() -> None:
    for data in (None, 3, "frame", [1, 2], {1, 2}, object()):
        refused("is no data frame", sb.Rig.from_frame, data)
    refused("has the shape (5,)", sb.Rig.from_frame, np.zeros(5))
    refused("has the shape (2, 3, 4)", sb.Rig.from_frame, np.zeros((2, 3, 4)))
    refused("there is no column", sb.Rig.from_frame, {})
    refused("there is no row", sb.Rig.from_frame, {"v": [], "y": []})
    refused("there is no row", sb.Rig.from_frame, np.zeros((0, 2)))


def test_what_is_no_column(v: np.ndarray, y: np.ndarray) -> None:
    refused("has 3 rows, but `v` has 600", sb.Rig.from_frame, {"v": v, "y": y[:3]}, sample_time=0.01)
    refused("`v` has the shape (600, 1)", sb.Rig.from_frame, {"v": v[:, None], "y": y}, sample_time=0.01)
    refused("`v` holds complex", sb.Rig.from_frame, {"v": v + 1j, "y": y}, sample_time=0.01)
    reported = refused("there is no column `w`; the columns are", sb.Rig.from_frame, {"v": v, "y": y}, input="w", sample_time=0.01)
    assert reported.startswith("frame: ")
    refused("there is no column `run`", sb.Rig.from_frame, {"v": v, "y": y}, record="run")
    refused("there is no column `z`", sb.Rig.from_frame, {"v": v, "y": y}, y_sim="z")
    pandas = pytest.importorskip("pandas")
    twice = pandas.DataFrame(np.column_stack([v, y]), columns=["v", "v"])
    refused("`v` stands 2 times", sb.Rig.from_frame, twice, sample_time=0.01)
    polars = pytest.importorskip("polars")
    refused("`collect()`", sb.Rig.from_frame, polars.DataFrame({"v": v, "y": y}).lazy())


def test_which_column_is_what_must_be_clear(v: np.ndarray, y: np.ndarray) -> None:
    reported = refused("is ambiguous", sb.Rig.from_frame, {"alpha": v, "beta": y, "gamma": y + 1}, sample_time=0.01)
    assert 'input="' in reported and "--input" not in reported


def test_numbers_that_are_none(v: np.ndarray, y: np.ndarray) -> None:
    y[[3, 7]] = np.inf
    reported = refused("frame, row 4: column `y`: `inf` is not finite", sb.Rig.from_frame, {"v": v, "y": y}, sample_time=0.01)
    assert "row 8" in reported
    words = v.astype(object)
    words[4] = "stuck"
    refused("frame, row 5: column `v`: `stuck` is not a number", sb.Rig.from_frame, {"v": words, "y": v}, sample_time=0.01)
    refused("", sb.Rig.from_frame, {"v": np.full(600, np.nan), "y": v}, sample_time=0.01)
    refused("never moves", sb.Rig.from_frame, {"v": np.ones(600), "y": v}, sample_time=0.01)
    refused("never changes", sb.Rig.from_frame, {"v": v, "y": np.ones(600)}, sample_time=0.01)


def test_what_is_missing_splits_the_record_and_is_told(v: np.ndarray, y: np.ndarray) -> None:
    y[300:310] = np.nan
    rig = sb.Rig.from_frame({"v": v, "y": y}, sample_time=0.01)
    assert sum(len(record) for record in rig.records) == 590
    assert "a dropout at frame, row 301 splits the record in two" in rig.reported


@pytest.mark.parametrize("kind", ["object", "pandas", "polars", "masked", "float32", "text"])
def test_numbers_in_other_dress(kind: str, v: np.ndarray, y: np.ndarray) -> None:
    dressed: Any
    if kind == "object":
        dressed = {"v": [float(x) for x in v], "y": np.array([None, *y[1:]], dtype=object)}
    elif kind == "text":
        dressed = {"v": v.astype(str), "y": ["NaN", *map(str, y[1:])]}
    elif kind == "masked":
        dressed = {"v": v, "y": np.ma.masked_array(y, mask=[True] + [False] * 599)}
    elif kind == "float32":
        dressed, v = {"v": v.astype(np.float32), "y": np.append(np.nan, y[1:])}, v.astype(np.float32).astype(float)
    elif kind == "pandas":
        pandas = pytest.importorskip("pandas")
        dressed = pandas.DataFrame({"v": pandas.array(v, dtype="Float64"), "y": pandas.array([None, *y[1:]], dtype="Float64")})
    else:
        polars = pytest.importorskip("polars")
        dressed = polars.DataFrame({"v": v, "y": [None, *map(float, y[1:])]})
    rig = sb.Rig.from_frame(dressed, sample_time=0.01)
    assert np.array_equal(np.concatenate([record.v for record in rig.records]), v[1:])
    assert np.array_equal(np.concatenate([record.y for record in rig.records]), y[1:])


@pytest.mark.parametrize("kind", ["numpy", "pandas", "zone", "polars", "delta", "text", "milliseconds"])
def test_times_in_other_dress(kind: str, v: np.ndarray, y: np.ndarray) -> None:
    stamps: Any = np.datetime64("2024-03-05T12:00:00") + (10 * np.arange(600)).astype("timedelta64[ms]")
    label = "time"
    if kind in ("pandas", "zone"):
        pandas = pytest.importorskip("pandas")
        stamps = pandas.Series(pandas.DatetimeIndex(stamps, tz="Europe/Berlin" if kind == "zone" else None))
    elif kind == "polars":
        stamps = pytest.importorskip("polars").Series(stamps)
    elif kind == "delta":
        stamps = stamps - stamps[0]
    elif kind == "text":
        stamps = [stamp.isoformat() for stamp in stamps.astype(datetime.datetime)]
    elif kind == "milliseconds":
        stamps, label = 10.0 * np.arange(600), "time [ms]"
    rig = sb.Rig.from_frame({label: stamps, "v": v, "y": y})
    assert rig.sample_time == pytest.approx(0.01, rel=1e-9) and len(rig.records) == 2


def test_times_that_cannot_be(v: np.ndarray, y: np.ndarray) -> None:
    t = 0.01 * np.arange(600)
    uneven = t + 0.004 * np.random.default_rng(0).uniform(-1, 1, 600)
    # Both signals as they are at these times: stamps that shake beside even samples are taken as even.
    taken = {"t": uneven, "v": np.interp(uneven, t, v), "y": np.interp(uneven, t, y)}
    reported = refused("uneven sampling", sb.Rig.from_frame, taken)
    assert "resample=True" in reported and "--" not in reported
    assert sb.Rig.from_frame(taken, resample=True).sample_time == pytest.approx(0.01, rel=1e-2)
    straight, held = (sb.Rig.from_frame(taken, resample=how) for how in ("linear", "hold"))
    same, other = (np.concatenate([record.y for record in rig.records]) for rig in (straight, held))
    assert np.array_equal(same, np.concatenate([record.y for record in sb.Rig.from_frame(taken, resample=True).records]))
    assert len(same) != len(other) or not np.array_equal(same, other)
    refused('give "linear", "hold" or True', sb.Rig.from_frame, taken, resample="cubic")
    assert sb.Rig.from_frame({"t": uneven, "v": v, "y": y}, time="none", sample_time=0.01).sample_time == 0.01
    refused("does not lie after", sb.Rig.from_frame, {"t": t[::-1], "v": v, "y": y})
    reported = refused("the sample time is not known", sb.Rig.from_frame, {"v": v, "y": y})
    assert "sample_time=0.01" in reported and "--" not in reported
    reported = refused("the sample time is 0.02 s", sb.Rig.from_frame, {"t": t, "v": v, "y": y}, sample_time=0.02)
    assert "sample_time=0.01" in reported


@pytest.mark.parametrize(
    ("option", "value", "words"),
    [
        ("sample_time", 0.0, "no time"),
        ("sample_time", -1.0, "no time"),
        ("order", 0, "no order"),
        ("order", -2, "no order"),
        ("order", 100, "no order"),
        ("interval", (5.0, -5.0), "interval"),
        ("interval", (1.0, 2.0, 3.0), "two numbers"),
        ("interval", (np.nan, 3.0), "finite"),
        ("sample_time", np.nan, "finite"),
        ("holdout", np.nan, "finite"),
        ("order", 1.5, "whole"),
        ("holdout", 1.5, "no share"),
        ("holdout", 0.0, "no share"),
        ("holdout", "other", "no such record"),
        ("holdout", ["frame"], "all is held out"),
        ("roles", {"frame": "pulse"}, "no role"),
        ("roles", {"other": "free"}, "no record `other`"),
        ("holdout", 0.999, "to fit"),
    ],
)
def test_arguments_that_cannot_be(frame: Frame, option: str, value: Any, words: str) -> None:
    refused(words, sb.Rig.from_frame, frame, **{option: value})


def test_short_records(frame: Frame) -> None:
    for rows in (1, 2, 5, 9):
        refused("", sb.Rig.from_frame, {name: values[:rows] for name, values in frame.items()})


def test_predictions_that_do_not_fit(frame: Frame) -> None:
    rig = sb.Rig.from_frame(frame)
    refused("`y_sim` has 3 values, but the records have 600 samples", sb.diagnose, rig, y_sim=[1, 2, 3])
    refused("no record `x`", sb.diagnose, rig, y_sim={"x": [1.0]})
    refused("has 1 values", sb.diagnose, rig, y_sim={"frame": [1.0]})
    refused("`y_sim` is nan at sample 1", sb.diagnose, rig, y_sim=np.full(600, np.nan))
    refused("has no column `y_sim`", sb.diagnose, rig, y_sim={"frame": rig.records[0].y})


def test_inputs_that_do_not_fit(frame: Frame) -> None:
    model = sb.identify(sb.Rig.from_frame(frame), "memoryless").model
    for v, words in [
        ([], "is empty"),
        ([1.0, np.nan], "nan at sample 2"),
        ([1.0, np.inf], "inf at sample 2"),
        (np.zeros((2, 2)), "shape (2, 2)"),
        (["a", "b"], "something else than numbers"),
        ([1j], "no real numbers"),
        (None, "shape ()"),
    ]:
        refused(words, model.simulate, v)
    refused("`y` has 1 values, but `v` has 2", model.simulate, [1.0, 2.0], [1.0])
    refused("infinite", model.simulate, [1.0, 2.0], [1.0, np.inf])
    refused("missing.csv", model.simulate, "missing.csv")
    refused("belongs to a file", model.simulate, [1.0, 2.0], input="v")
    refused("between 0 and 50", model.bode, [51.0])


def test_models_that_are_none(frame: Frame, tmp_path: Path) -> None:
    rig = sb.Rig.from_frame(frame)
    refused("no JSON", sb.Model, "{")
    refused("cannot be read", sb.diagnose, rig, "missing.json")
    refused("is no model", sb.diagnose, rig, 7)
    (tmp_path / "other.json").write_text('{"schema": "switchback/gap/1", "kind": "x"}')
    refused("but a model is wanted", sb.diagnose, rig, tmp_path / "other.json")
    other = sb.identify(sb.Rig.from_frame(frame, time="none", sample_time=0.02), "memoryless").model
    refused("sample time of 0.02 s", sb.diagnose, rig, other)


def test_rigs_that_are_none() -> None:
    refused("is no rig", sb.identify, 3)
    refused("missing.toml", sb.identify, "missing.toml")
    refused("belongs to files of measurements", sb.Rig.read, "rig.toml", input="v")
    with pytest.raises(sb.SwitchbackError, match="DATA"):
        sb.Rig.read()
    with pytest.raises(TypeError, match=r"Rig\.read"):
        sb.Rig("rig.toml")  # type: ignore[arg-type]


def test_scenarios_that_are_none() -> None:
    refused("`study`", sb.study, {})
    refused("not finite", sb.study, {"study": "consistency", "seed": float("nan")})
    refused("no object", sb.study, {"study": object()})
    refused("which only the command line runs", sb.study, QUICK.with_name("blind-slice.toml"))
    refused("a rig", sb.study, QUICK.parent / "rigs/leaf-spring/rig.toml")
    refused("missing.toml", sb.study, "missing.toml")
    refused("'fastest'", sb.study, QUICK, engine="fastest")


def test_plans_that_cannot_be() -> None:
    refused("`rate` is missing", sb.design, 2, 8, (-1, 1))
    refused("--points", sb.design, 2, 0, (-1, 1), 100)
    refused("--rate", sb.design, 2, 8, (-1, 1), -100)
    refused("give two numbers", sb.design, 2, 8, (1, 2, 3), 100)
    refused("needs `--from", sb.design, 2, 8, (-1, 1), 100, precision=0.01)


def test_every_error_is_a_value_error(frame: Frame) -> None:
    with pytest.raises(ValueError, match="invalid value 'best' for '--method"):
        sb.identify(sb.Rig.from_frame(frame), "best")  # type: ignore[arg-type]
