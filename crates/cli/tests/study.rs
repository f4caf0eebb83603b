//! `switchback SCENARIO.toml`, as a user runs it.

use crate::common::STUDY;
use assert_cmd::Command;
use std::fs;
use std::path::{Path, PathBuf};
use switchback_study::scenario::Engine;

fn switchback() -> Command {
    Command::cargo_bin("switchback").expect("the program is built")
}

fn shipped(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios").join(name)
}

struct Folder(tempfile::TempDir);

impl Folder {
    fn with(scenario: &str) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        fs::write(folder.path().join("study.toml"), scenario).expect("it can be written");
        Self(folder)
    }

    fn run(&self, arguments: &[&str]) -> std::process::Output {
        let mut command = switchback();
        command.current_dir(self.0.path()).arg("study.toml").args(arguments);
        command.output().expect("the program runs")
    }

    fn report(&self) -> PathBuf {
        self.0.path().join("reports/study")
    }
}

/// Runs a broken scenario: exit code 2, every word reported, nothing written.
fn refused(scenario: &str, words: &[&str]) {
    let folder = Folder::with(scenario);
    let output = folder.run(&[]);
    let reported = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{reported}");
    for word in words {
        assert!(reported.contains(word), "`{word}` is missing in: {reported}");
    }
    assert!(!folder.0.path().join("reports").exists(), "nothing is written on bad input");
    assert!(output.stdout.is_empty());
}

#[test]
fn a_report_appears_where_the_scenario_s_name_says() {
    let folder = Folder::with(STUDY);
    let output = folder.run(&[]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    for file in
        ["results.json", "table.csv", "bias-efficient.svg", "sd-efficient.svg", "borders-efficient.svg"]
    {
        assert!(folder.report().join(file).is_file(), "{file} is missing");
    }
    assert!(String::from_utf8_lossy(&output.stdout).contains("efficient"));
}

#[test]
fn every_byte_is_the_same_at_one_two_and_eight_threads() {
    let folder = Folder::with(STUDY);
    let runs = ["1", "2", "8"].map(|threads| {
        let output = folder.run(&["--threads", threads, "--out", threads, "--quiet"]);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        let mut files: Vec<(String, Vec<u8>)> = fs::read_dir(folder.0.path().join(threads))
            .expect("the report's folder")
            .map(|entry| entry.expect("an entry"))
            .filter(|entry| entry.file_name() != "provenance.json")
            .filter(|entry| entry.file_name() != ".switchback.beside.sha256")
            .map(|entry| {
                (entry.file_name().to_string_lossy().into_owned(), fs::read(entry.path()).expect("readable"))
            })
            .collect();
        files.sort();
        files
    });
    assert_eq!(runs[0], runs[1]);
    assert_eq!(runs[0], runs[2]);
}

#[test]
fn the_engine_is_chosen_on_the_command_line_or_in_the_scenario_and_the_results_name_it() {
    let folder = Folder::with(STUDY);
    assert_eq!(folder.run(&["--engine", "direct", "--out", "flag", "--quiet"]).status.code(), Some(0));
    let key = STUDY.replace("seed = 3", "seed = 3\nengine = \"direct\"");
    fs::write(folder.0.path().join("study.toml"), key).expect("it can be written");
    assert_eq!(folder.run(&["--out", "key", "--quiet"]).status.code(), Some(0));
    let results = ["flag", "key"].map(|name| switchback_study::results::read(&folder.0.path().join(name)));
    let [flag, key] = results.map(|r| r.expect("results"));
    assert_eq!((flag.engine, key.engine), (Engine::Direct, Engine::Direct));
    assert_eq!((flag.command.as_str(), &flag.cells), ("switchback study.toml --engine direct", &key.cells));
    let unknown = folder.run(&["--engine", "dirct"]);
    let reported = String::from_utf8_lossy(&unknown.stderr).into_owned();
    assert_eq!(unknown.status.code(), Some(2));
    assert!(reported.contains("dirct") && reported.contains("superposed, direct"), "{reported}");
}

#[test]
fn an_expectation_that_does_not_hold_exits_1_after_the_report_is_written() {
    let folder = Folder::with(&format!("{STUDY}[expect]\ninconsistent = [\"efficient\"]\n"));
    let output = folder.run(&[]);
    assert_eq!(output.status.code(), Some(1));
    assert!(folder.report().join("results.json").is_file());
}

#[test]
fn results_agree_with_themselves_and_not_with_another_truth() {
    let folder = Folder::with(STUDY);
    assert_eq!(folder.run(&["--out", "old", "--quiet"]).status.code(), Some(0));
    let coloured = "[[case]]\nname = \"as stated\"\ndisturbance = { kind = \"output\" }\n";
    let other = STUDY.replace("[sweep]", &format!("{coloured}[sweep]"));
    let same = STUDY.replace("[sweep]", "[[case]]\nname = \"as stated\"\n[sweep]");
    for (name, scenario) in [("same", same), ("other", other)] {
        fs::write(folder.0.path().join("study.toml"), scenario).expect("it can be written");
        assert_eq!(folder.run(&["--out", name, "--quiet"]).status.code(), Some(0));
    }
    let compare = |one: &str, two: &str| {
        let mut command = switchback();
        command
            .current_dir(folder.0.path())
            .args(["compare", one, two])
            .output()
            .expect("it runs")
            .status
            .code()
    };
    assert_eq!(compare("same", "same"), Some(0));
    assert_eq!(compare("same", "other"), Some(1));
    assert_eq!(compare("same", "nowhere"), Some(2));
}

#[test]
fn bad_scenarios_are_refused_with_file_place_and_remedy() {
    refused(&STUDY.replace("replicates", "replicats"), &["study.toml:4", "replicats", "replicates"]);
    refused(&STUDY.replace("a = [-0.7]", "a = [-1.7]"), &["study.toml:6", "unstable"]);
    refused(
        &STUDY.replace("a = [-0.7]", "a = [-1.2, 0.5]").replace("b = [0.3]", "b = [0.3, -0.3]"),
        &["study.toml", "B(1)"],
    );
    refused(&STUDY.replace("[200, 1000]", "[5, 1000]"), &["study.toml:16", "5", "period"]);
    refused(&STUDY.replace("[0.1]", "[-0.1]"), &["study.toml:15", "noise"]);
    refused(&STUDY.replace("friction = 0.3", "friction = \"much\""), &["study.toml:13", "friction"]);
    refused(&STUDY.replace("stiffness = 1.0", "stiffness = -1.0"), &["study.toml", "Assumption 1"]);
    refused(&STUDY.replace("\"efficient\"", "\"eficient\""), &["study.toml:18", "efficient"]);
    refused(
        &STUDY.replace("\"consistency\"", "\"consistence\""),
        &["study.toml:1", "consistence", "\"blind\""],
    );
    refused("study = \"gap\"\n", &["study.toml:1", "no such study", "\"consistency\""]);
    refused("study = ", &["study.toml:1"]);
    refused("", &["study.toml", "study"]);
}

#[test]
fn a_report_that_cannot_be_written_is_reported_before_anything_is_computed() {
    let folder = Folder::with(STUDY);
    let output = folder.run(&["--out", "study.toml/inside"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("study.toml/inside"));
}

#[test]
fn a_missing_scenario_and_a_folder_are_refused() {
    let folder = Folder::with(STUDY);
    for path in ["absent.toml", "."] {
        let output = switchback().current_dir(folder.0.path()).arg(path).output().expect("it runs");
        assert_eq!(output.status.code(), Some(2));
        assert!(String::from_utf8_lossy(&output.stderr).contains(path));
    }
}

#[test]
fn every_shipped_scenario_can_be_read() {
    for entry in fs::read_dir(shipped("")).expect("the scenarios") {
        let path = entry.expect("an entry").path();
        let is_consistency = path.extension().is_some_and(|e| e == "toml")
            && fs::read_to_string(&path).expect("readable").contains("study = \"consistency\"");
        if is_consistency {
            switchback_study::scenario::Scenario::read(&path)
                .unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        }
    }
}
