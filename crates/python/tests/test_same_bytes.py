"""Every verb gives the bytes of the command line: both are run."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import switchback as sb
from conftest import BENCH, LEAF_SPRING, QUICK, Program, drive


def same_folder(ours: Path, theirs: Path) -> None:
    """What reports a run rather than of what came out is not compared."""

    def files(folder: Path) -> dict[str, bytes]:
        return {
            path.name: path.read_bytes()
            for path in folder.iterdir()
            if path.is_file() and not path.name.startswith(".") and path.name not in ("provenance.json", "replicates.sums")
        }

    assert files(ours) == files(theirs)


def test_identify_and_its_folder(program: Program, short_csv: Path, tmp_path: Path) -> None:
    found = sb.identify(sb.Rig.read(short_csv))
    assert found.to_json() == program.json("identify", short_csv, "--out", "theirs")
    same_folder(found.save(tmp_path / "ours"), tmp_path / "theirs")
    assert found.words == program.run("identify", short_csv).stdout


@pytest.mark.parametrize("method", ["linear-arx", "memoryless"])
def test_identify_by_another_method(program: Program, short_csv: Path, method: sb._identification.Method) -> None:
    found = sb.identify(sb.Rig.read(short_csv, holdout=0.25), method, causal=True, threads=1)
    assert found.to_json() == program.json("identify", short_csv, "--holdout", 0.25, "--method", method, "--causal")


def test_identify_from_designed_experiments(program: Program) -> None:
    found = sb.identify(LEAF_SPRING)
    assert found.to_json() == program.json("identify", LEAF_SPRING)
    assert found.method in ("efficient", "joint")


def test_diagnose_the_bench_and_its_folder(program: Program, tmp_path: Path) -> None:
    found = sb.diagnose(sb.Rig.read(BENCH))
    assert found.to_json() == program.json("gap", BENCH, "--out", "theirs")
    same_folder(found.save(tmp_path / "ours"), tmp_path / "theirs")
    assert found.verdict.effects == ["backlash"]


def test_diagnose_with_options_and_a_model_in_memory(program: Program, short_csv: Path, tmp_path: Path) -> None:
    rig = sb.Rig.read(short_csv)
    model = sb.identify(rig).model
    model.save(tmp_path / "model.json")
    options = ("--without", "creep", "--without", "stribeck", "--ask", "coloured_noise", "--prior", "none=0.2,unexplained=0.1")
    theirs = program.json("gap", short_csv, "--model", "model.json", *options)
    ours = sb.diagnose(rig, model, without=["creep", "stribeck"], ask="coloured_noise", prior={"none": 0.2, "unexplained": 0.1})
    assert ours.to_json() == theirs
    assert ours.words + ours.explain() == program.run("gap", short_csv, "--model", "model.json", *options, "--explain").stdout


def test_diagnose_another_simulator(program: Program, short_csv: Path, tmp_path: Path) -> None:
    rig = sb.Rig.read(short_csv)
    y_sim = np.concatenate([0.9 * record.y + 0.1 for record in rig.records])
    lines = short_csv.read_text().splitlines()
    rows = [lines[0] + ",y_sim"] + [f"{line},{float(y)!r}" for line, y in zip(lines[1:], y_sim)]
    (tmp_path / "other").mkdir()
    (tmp_path / "other/short.csv").write_text("\n".join(rows) + "\n")
    assert sb.diagnose(rig, y_sim=y_sim).to_json() == program.json("gap", "other/short.csv")


def test_simulate_a_file_and_an_array(program: Program, short_csv: Path, tmp_path: Path) -> None:
    model = sb.identify(sb.Rig.read(short_csv)).model
    model.save(tmp_path / "model.json")
    ours = sb.Model.read(tmp_path / "model.json").simulate(short_csv)
    assert ours.to_json() == program.json("simulate", "model.json", short_csv)
    assert ours.to_csv() == program.run("simulate", "model.json", short_csv, "--quiet").stdout
    v = drive(200, seed=5)
    (tmp_path / "input.csv").write_text("travel\n" + "\n".join(repr(float(x)) for x in v) + "\n")
    run = model.simulate(v)
    printed = np.genfromtxt(
        program.run("simulate", "model.json", "input.csv", "--quiet").stdout.splitlines(), delimiter=",", names=True
    )
    assert (
        np.array_equal(printed["y"], run.y)
        and np.array_equal(printed["y_low"], run.low)
        and np.array_equal(printed["y_high"], run.high)
    )


def test_export(program: Program, short_csv: Path, tmp_path: Path) -> None:
    model = sb.identify(sb.Rig.read(short_csv), causal=True).model
    model.save(tmp_path / "model.json")
    file = tmp_path / "machine.h"
    done = program.run("export", "model.json", "--to", "c", "--out", "machine.h")
    assert done.returncode == 0, done.stderr
    theirs = file.read_bytes()
    assert model.export("c", file) == theirs == file.read_bytes()


def test_design_and_its_folder(program: Program, tmp_path: Path) -> None:
    found = sb.design(2, 8, (-20, 20), 200, periods=20, out="theirs")
    words = ("design", "--order", 2, "--points", 8, "--interval", "-20,20", "--rate", 200, "--periods", 20, "--out", "theirs")
    assert found.to_json() == program.json(*words)
    same_folder(found.save(tmp_path / "ours"), tmp_path / "theirs")


def test_design_from_a_rig(program: Program) -> None:
    found = sb.design(rig=LEAF_SPRING, precision="1%")
    assert found.to_json() == program.json("design", "--from", LEAF_SPRING, "--precision", "1%")
    assert found.prediction is not None


def test_plant_and_what_is_made_of_it(program: Program, short_csv: Path, tmp_path: Path) -> None:
    ours = sb.plant(sb.Rig.read(short_csv), "backlash", 3.0, seed=2)
    theirs = program.json("plant", short_csv, "--effect", "backlash", "--size", 3, "--seed", 2, "--out", "theirs")
    assert ours.to_json() == theirs
    same_folder(ours.save(tmp_path / "ours"), tmp_path / "theirs")
    from_memory, from_files = sb.identify(ours.rig), sb.identify(tmp_path / "theirs/rig.toml")
    assert from_memory.to_json() == from_files.to_json()


def test_power(program: Program, short_csv: Path) -> None:
    ours = sb.power(sb.Rig.read(short_csv), ["output_noise"], draws=1, seed=3)
    theirs = program.json("gap", short_csv, "--power", "--effects", "output_noise", "--draws", 1, "--seed", 3)
    assert ours.to_json() == theirs
    assert [one.effect for one in ours.effects] == ["output_noise"]


def test_a_study_from_a_file_and_from_a_mapping(program: Program, tmp_path: Path) -> None:
    from_file = sb.study(QUICK)
    assert from_file.to_json() == program.json(QUICK, "--out", "theirs")
    same_folder(from_file.save(tmp_path / "ours"), tmp_path / "theirs")
    tomllib = pytest.importorskip("tomllib")
    from_mapping = sb.study(tomllib.loads(QUICK.read_text()), name="quick")
    assert from_mapping.to_json() == from_file.to_json()
    assert from_mapping.scenario is not None
    assert tomllib.loads(from_mapping.scenario) == tomllib.loads(QUICK.read_text())


def test_frames_give_what_files_give(short_csv: Path, frame: dict[str, np.ndarray]) -> None:
    pandas, polars = pytest.importorskip("pandas"), pytest.importorskip("polars")
    structured = np.zeros(600, dtype=[(name, float) for name in frame])
    for name, values in frame.items():
        structured[name] = values
    expected = sb.identify(sb.Rig.read(short_csv), "linear-arx").to_json()
    for data in (frame, pandas.DataFrame(frame), polars.DataFrame(frame), structured):
        assert sb.identify(sb.Rig.from_frame(data, name="short"), "linear-arx").to_json() == expected, type(data)
    plain = np.column_stack(list(frame.values()))
    rig = sb.Rig.from_frame(plain, time=1, input=2, output=3, name="short")
    assert all(np.array_equal(a.y, b.y) for a, b in zip(rig.records, sb.Rig.read(short_csv).records))


def test_several_records_of_a_frame_are_several_files(program: Program, frame: dict[str, np.ndarray], tmp_path: Path) -> None:
    runs = np.repeat(["first", "second", "third"], 200)
    for run in ("first", "second", "third"):
        rows = [",".join(frame)] + [
            ",".join(map(repr, map(float, row))) for row, own in zip(zip(*frame.values()), runs) if own == run
        ]
        (tmp_path / f"{run}.csv").write_text("\n".join(rows) + "\n")
    rig = sb.Rig.from_frame({**frame, "run": runs}, record="run", name="first")
    assert [(record.name, record.use) for record in rig.records] == [("first", "fit"), ("second", "fit"), ("third", "holdout")]
    theirs = program.json("identify", "first.csv", "second.csv", "third.csv", "--method", "linear-arx")
    assert sb.identify(rig, "linear-arx").to_json() == theirs


def test_errors_have_the_words_of_the_command_line(program: Program, short_csv: Path, tmp_path: Path) -> None:
    (tmp_path / "text.csv").write_text("t,v,y\n0,1,2\n0.1,zwei,3\n0.2,3,4\n0.3,4,5\n")
    (tmp_path / "rig.toml").write_text("name = 'x'\noder = 2\n")
    (tmp_path / "study.toml").write_text(QUICK.read_text().replace("replicates = 80", "replicates = -1"))
    rig = sb.Rig.read(short_csv)

    def refused(call: object, *arguments: object, **options: object) -> str:
        with pytest.raises(sb.SwitchbackError) as caught:
            call(*arguments, **options)  # type: ignore[operator]
        return str(caught.value)

    def here(text: str) -> str:
        return text.replace(f"{tmp_path}/", "")

    assert here(refused(sb.Rig.read, tmp_path / "text.csv")) == program.error("gap", "text.csv")
    assert here(refused(sb.Rig.read, tmp_path / "rig.toml")) == program.error("gap", "rig.toml")
    assert here(refused(sb.Rig.read, tmp_path / "missing.csv")) == program.error("gap", "missing.csv")
    assert here(refused(sb.study, tmp_path / "study.toml")) == program.error("study.toml")
    assert refused(sb.identify, rig, "paper-descendant") == program.error("identify", short_csv, "--method", "paper-descendant")
    assert refused(sb.design, 2, 8, (20, -20), 200) == reported(
        program, "design", "--order=2", "--points=8", "--interval=20,-20", "--rate=200", "--out=x"
    )
    assert refused(sb.diagnose, rig, without="backlas") == reported(program, "gap", short_csv, "--without=backlas")
    assert refused(sb.plant, rig, "backlas") == program.error("plant", short_csv, "--effect", "backlas", "--out", "x")


def reported(program: Program, *words: object) -> str:
    """What the command line says to words that it does not understand, without how to ask it for help."""
    return program.error(*words).split("\n\nUsage:")[0].split("\n\nFor more information")[0].rstrip()
