//! FMUs: those of `export --to fmu`, run by FMPy and by `gap --fmu`, and those of others in `gap --fmu`.
//!
//! Without a C compiler, or a Python with FMPy (`SWITCHBACK_PYTHON`), what needs them says so and is left out.

use crate::common::Folder;
use std::env::consts::DLL_SUFFIX;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

fn shipped(name: &str) -> String {
    let rigs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/rigs");
    rigs.join(name).join("rig.toml").display().to_string()
}

/// Exit code, stdout and stderr.
fn run(folder: &Folder, arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = folder.switchback(arguments).output().expect("it runs");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (output.status.code(), text(&output.stdout), text(&output.stderr))
}

fn succeed(folder: &Folder, arguments: &[&str]) -> String {
    let (code, out, reported) = run(folder, arguments);
    assert_eq!(code, Some(0), "{arguments:?}: {reported}");
    out
}

/// Exit code 2 and a message with all the words in it.
fn refused(folder: &Folder, arguments: &[&str], words: &[&str]) {
    let (code, _, reported) = run(folder, arguments);
    assert_eq!(code, Some(2), "{reported}");
    for word in words {
        assert!(reported.contains(word), "`{word}` is not in: {reported}");
    }
}

fn input(folder: &Folder) {
    let at = |t: i32| {
        let t = f64::from(if t % 41 > 33 { t - t % 41 + 33 } else { t });
        0.6 * (0.23 * t).sin() + 0.35 * (0.71 * t).sin()
    };
    let rows: String = (0..260).map(|t| format!("{:?}\n", at(t))).collect();
    folder.write("input.csv", &format!("v\n{rows}"));
}

/// A Python that has a package, named in SWITCHBACK_PYTHON.
fn python_with(package: &str) -> Option<String> {
    let python = std::env::var("SWITCHBACK_PYTHON").ok()?;
    let found = Command::new(&python).args(["-c", &format!("import {package}")]).output().ok()?;
    found.status.success().then_some(python)
}

fn in_fmpy(folder: &Folder, model: &str, python: &str) {
    let (out, expected) = ("a folder/100 %/model.fmu", simulated(folder, model));
    succeed(folder, &["export", model, "--to", "fmu", "--out", out, "--force", "--quiet"]);
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fmu/run.py");
    // The place that FMPy unpacks to has a blank and a per cent sign.
    let temporary = folder.path("a folder/100 %/temporary");
    fs::create_dir_all(&temporary).expect("a folder");
    let output = Command::new(python)
        .arg(script)
        .args([out, "input.csv"])
        .env("TMPDIR", temporary)
        .current_dir(folder.path(""))
        .output()
        .expect("it runs");
    assert!(output.status.success(), "{model}: {}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let numbers: Vec<f64> = text.lines().filter_map(|line| line.parse().ok()).collect();
    let size = expected.iter().fold(0.0, |most: f64, y| most.max(y.abs()));
    assert_eq!(numbers.len(), expected.len(), "{text}");
    for (t, (found, y)) in numbers.iter().zip(&expected).enumerate() {
        assert!((found - y).abs() <= 1e-12 * size, "{model}, sample {t}: {found}, but simulate gives {y}");
    }
}

fn simulated(folder: &Folder, model: &str) -> Vec<f64> {
    succeed(
        folder,
        &["simulate", model, "input.csv", "--output", "none", "--out", "run.csv", "--force", "--quiet"],
    );
    let text = fs::read_to_string(folder.path("run.csv")).expect("a file");
    text.lines().skip(1).map(|line| line.split(',').nth(2).expect("y").parse().expect("a number")).collect()
}

#[test]
fn fmpy_runs_an_exported_model_as_simulate_does() {
    let Some(python) = python_with("fmpy") else {
        eprintln!("SKIPPED: SWITCHBACK_PYTHON names no Python with FMPy; .ci/export makes one");
        return;
    };
    let folder = Folder::with_good_rig();
    input(&folder);
    succeed(&folder, &["identify", "rig.toml", "--out", "found", "--quiet"]);
    in_fmpy(&folder, "found/model.json", &python);
    // An output that depends on the input of its own sample is a sample late.
    folder.edit("found/model.json", |text| {
        let mut model: serde_json::Value = serde_json::from_str(text).expect("a model");
        model["model"]["delay"] = (-1).into();
        model["model"]["b"].as_array_mut().expect("a list").push(0.05.into());
        let sum = |of: &str| {
            model["model"][of].as_array().expect("a list").iter().filter_map(|x| x.as_f64()).sum::<f64>()
        };
        // Where it rests follows from all coefficients.
        model["model"]["gain"] = (sum("b") / (1.0 + sum("a"))).into();
        model["model"]["covariance"] = serde_json::Value::Null;
        model.to_string()
    });
    in_fmpy(&folder, "found/model.json", &python);
    // A name and units that XML and URIs must not stumble over.
    folder.edit("found/model.json", |text| text.replace("\"small\"", "\"a < b & \\\"c\\\" 100 %s\""));
    in_fmpy(&folder, "found/model.json", &python);
}

/// Exports a model of the rig with a play, diagnoses the rig beside it, and expects something.
fn diagnosed_beside(model: &str, expected: &str) {
    let folder = Folder::with_good_rig();
    let rig = shipped("leaf-spring-with-backlash");
    succeed(&folder, &["gap", &rig, "--out", "report", "--quiet"]);
    let model = format!("report/{model}.json");
    succeed(&folder, &["export", &model, "--to", "fmu", "--name", "sim", "--force", "--quiet"]);
    let (code, out, reported) =
        run(&folder, &["gap", &rig, "--fmu", "sim.fmu", "--expect", expected, "--json"]);
    assert_eq!(code, Some(0), "{model}: {reported}");
    let page: serde_json::Value = serde_json::from_str(&out).expect("one JSON object");
    assert_eq!(page["model"], "y_sim");
    assert!(reported.contains("as expected: "), "{reported}");
}

#[test]
fn an_exported_simulator_without_the_play_lacks_it() {
    diagnosed_beside("nominal", "cause backlash");
}

/// Only the first samples differ: the simulator begins at rest, the rig in the middle of a move.
#[test]
fn an_exported_simulator_with_the_play_follows_the_rig() {
    diagnosed_beside("augmented", "gap < 1 %");
}

#[test]
fn what_is_not_as_expected_exits_with_one_after_the_report_is_written() {
    let folder = Folder::with_good_rig();
    let arguments =
        ["gap", "rig.toml", "--expect", "gap < 1e-9 %", "--expect", "gap<50%", "--quiet", "--out", "out"];
    let (code, _, reported) = run(&folder, &arguments);
    assert_eq!(code, Some(1), "{reported}");
    assert!(
        reported.contains("not as expected: gap < 1e-9 %; found") && !reported.contains("gap<50%"),
        "{reported}"
    );
    assert!(folder.path("out/gap.json").exists());
    for (typo, word) in
        [("gab < 2 %", "gap.before"), ("cause backlsh", "backlash"), ("gap < 2 percent", "gap < 2 %")]
    {
        refused(&folder, &["gap", "rig.toml", "--expect", typo], &[word]);
    }
}

/// An FMU from the C file beside this test; `failure` is the number of its failure, 0 for none.
fn by_hand(folder: &Folder, failure: u8, description: &str) -> Option<PathBuf> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fmu/simulator.c");
    let library = folder.path(&format!("hand{failure}{DLL_SUFFIX}"));
    let made = Command::new("cc")
        .args(["-shared", "-fPIC", "-O1", &format!("-DFAILURE={failure}")])
        .arg(source)
        .arg("-o")
        .arg(&library)
        .output();
    if made.is_err() {
        eprintln!("SKIPPED: there is no C compiler `cc`");
        return None;
    }
    assert!(library.exists(), "{made:?}");
    let place = folder.path("hand.fmu");
    let binary = format!("binaries/{}/hand{DLL_SUFFIX}", switchback_io::export::platform());
    let entries = [
        ("modelDescription.xml", description.as_bytes().to_vec()),
        (&binary, fs::read(library).expect("built")),
    ];
    archive(&place, &entries);
    Some(place)
}

pub(crate) fn archive(place: &Path, entries: &[(&str, Vec<u8>)]) {
    let mut archive = zip::ZipWriter::new(fs::File::create(place).expect("a file"));
    for (name, bytes) in entries {
        archive.start_file(*name, zip::write::SimpleFileOptions::default()).expect("an entry");
        archive.write_all(bytes).expect("written");
    }
    archive.finish().expect("an archive");
}

pub(crate) const DESCRIPTION: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="hand" guid="{1}">
  <CoSimulation modelIdentifier="hand"/>
  <ModelVariables>
    <ScalarVariable name="position" valueReference="4" causality="input"><Real start="0"/></ScalarVariable>
    <ScalarVariable name="load" valueReference="5" causality="input"><Real start="0"/></ScalarVariable>
    <ScalarVariable name="force" valueReference="7" causality="output"><Real unit="N"/></ScalarVariable>
    <ScalarVariable name="broken" valueReference="8" causality="output"><Boolean/></ScalarVariable>
  </ModelVariables>
  <ModelStructure/>
</fmiModelDescription>
"#;

const MAP: &str = "v=position,y=force";

#[test]
fn a_simulator_by_hand_is_run_and_what_it_fails_at_is_reported() {
    let folder = Folder::with_good_rig();
    let Some(_) = by_hand(&folder, 0, DESCRIPTION) else { return };
    let page = succeed(&folder, &["gap", "rig.toml", "--fmu", "hand.fmu", "--map", MAP, "--json"]);
    let page: serde_json::Value = serde_json::from_str(&page).expect("one JSON object");
    assert_eq!(page["model"], "y_sim");
    // Twice the input has no dynamics and no hysteresis.
    assert!(page["gap"]["before"]["estimate"].as_f64().expect("a number") > 0.1, "{:#}", page["gap"]);

    let gap = |map: &'static str| ["gap", "rig.toml", "--fmu", "hand.fmu", "--map", map, "--patience", "2"];
    refused(
        &folder,
        &gap("v=positon,y=force"),
        &["no real input `positon`", "position, load", "did you mean `--map v=position`?"],
    );
    refused(&folder, &gap("v=position,y=broken"), &["no real output `broken`"]);
    refused(
        &folder,
        &["gap", "rig.toml", "--fmu", "hand.fmu"],
        &["which input is `v` is ambiguous", "--map v=NAME"],
    );
    let failures: [(u8, &[&str]); 5] = [
        (1, &["crashed", "the record descendant"]),
        (2, &["did not return within 2 s"]),
        (3, &["refuses a step of 0.01 s", "the record descendant"]),
        (4, &["makes no instance"]),
        (5, &["no finite number", "the record descendant"]),
    ];
    for (failure, words) in failures {
        by_hand(&folder, failure, DESCRIPTION);
        refused(&folder, &gap(MAP), words);
    }
}

#[test]
fn what_is_no_fmu_for_this_is_reported() {
    let folder = Folder::with_good_rig();
    let gap = ["gap", "rig.toml", "--fmu", "hand.fmu", "--map", MAP];
    refused(&folder, &gap, &["hand.fmu"]);
    folder.write("hand.fmu", "no archive");
    refused(&folder, &gap, &["this is no FMU, which is a zip archive"]);
    let with = |description: &str| {
        let entries = [
            ("modelDescription.xml", description.as_bytes().to_vec()),
            ("binaries/amiga32/hand.so", Vec::new()),
        ];
        archive(&folder.path("hand.fmu"), &entries);
    };
    with("<fmiModelDescription");
    refused(&folder, &gap, &["modelDescription.xml"]);
    with(&DESCRIPTION.replace("\"2.0\"", "\"3.0\""));
    refused(&folder, &gap, &["an FMU of FMI 3.0, but 2.0 is wanted"]);
    with(&DESCRIPTION.replace("CoSimulation", "ModelExchange"));
    refused(&folder, &gap, &["not for co-simulation"]);
    with(DESCRIPTION);
    refused(&folder, &gap, &["no library for this platform", "it has: amiga32"]);
    archive(&folder.path("hand.fmu"), &[("../../evil.txt", b"x".to_vec())]);
    refused(&folder, &gap, &["`../../evil.txt` would be written outside of it"]);
    refused(&folder, &["gap", "rig.toml", "--map", MAP], &["--fmu"]);
    refused(&folder, &["gap", "rig.toml", "--fmu", "hand.fmu", "--map", "x=1"], &["v=position,y=force"]);
}

#[test]
fn units_that_differ_are_reported() {
    let folder = Folder::with_good_rig();
    folder.edit("rig.toml", |text| {
        text.replacen("order = 2", "order = 2\ninput = \"travel [mm]\"\noutput = \"force [kN]\"", 1)
    });
    let Some(_) = by_hand(&folder, 0, DESCRIPTION) else { return };
    let gap = ["gap", "rig.toml", "--fmu", "hand.fmu", "--map", MAP];
    refused(&folder, &gap, &["`force` is in N, but the records have kN"]);
}

/// Where pythonfmu's library finds a Python: the shared library, the packages and the home of one.
const WHERE: &str = "import os, sys, sysconfig, pythonfmu\n\
    name = sysconfig.get_config_var('INSTSONAME') or sysconfig.get_config_var('LDLIBRARY')\n\
    print(os.path.join(sysconfig.get_config_var('LIBDIR'), name))\n\
    print(os.path.dirname(os.path.dirname(pythonfmu.__file__)))\n\
    print(sys.base_prefix)";

/// One made by pythonfmu, which needs a Python that is a shared library, loaded beforehand.
#[test]
fn a_simulator_that_pythonfmu_builds_is_run() {
    let Some(python) = python_with("pythonfmu") else {
        eprintln!("SKIPPED: SWITCHBACK_PYTHON names no Python with pythonfmu; .ci/export makes one");
        return;
    };
    let folder = Folder::with_good_rig();
    folder.write(
        "spring.py",
        "from pythonfmu import Fmi2Causality, Fmi2Slave, Real\n\n\n\
         class Spring(Fmi2Slave):\n    def __init__(self, **kwargs):\n        super().__init__(**kwargs)\n        \
         self.v = 0.0\n        self.y = 0.0\n        \
         self.register_variable(Real('v', causality=Fmi2Causality.input))\n        \
         self.register_variable(Real('y', causality=Fmi2Causality.output))\n\n    \
         def do_step(self, now, step):\n        self.y += 0.3 * (0.6 * self.v - self.y)\n        return True\n",
    );
    let built = Command::new(&python)
        .args(["-m", "pythonfmu", "build", "-f", "spring.py"])
        .current_dir(folder.path(""))
        .output()
        .expect("it runs");
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    let reported = Command::new(&python).args(["-c", WHERE]).output().expect("it runs").stdout;
    let reported = String::from_utf8(reported).expect("text");
    let [library, packages, home] = reported.lines().collect::<Vec<_>>()[..] else {
        panic!("three lines: {reported}")
    };
    if !Path::new(library).exists() || !library.contains(".so") {
        eprintln!(
            "SKIPPED: this Python is no shared library, without which pythonfmu's cannot be loaded: {library}"
        );
        return;
    }
    let output = folder
        .switchback(&["gap", "rig.toml", "--fmu", "Spring.fmu", "--json"])
        .env("LD_PRELOAD", library)
        .env("PYTHONPATH", packages)
        .env("PYTHONHOME", home)
        .output()
        .expect("it runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let page: serde_json::Value = serde_json::from_slice(&output.stdout).expect("one JSON object");
    assert_eq!(page["model"], "y_sim");
    assert!(page["gap"]["before"]["estimate"].as_f64().expect("a number") > 0.0);
}
