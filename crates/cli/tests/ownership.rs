//! No verb overwrites what someone else wrote, unless it is asked to.

use crate::common::{BLIND, Folder, STUDY, listing};
use std::fs;

const FOREIGN: &str = "measured for three weeks\n";

/// Runs a verb into `out` while a file of one of its names lies there, then by force, then again, then after an edit.
#[track_caller]
fn respects(arguments: &[&str], name: &str) {
    let folder = Folder::with_good_rig();
    folder.write("study.toml", STUDY);
    let run = |more: &[&str]| {
        let output =
            folder.switchback(arguments).args(["--out", "out"]).args(more).output().expect("it runs");
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    fs::create_dir(folder.path("out")).expect("a new folder");
    folder.write(&format!("out/{name}"), FOREIGN);
    folder.write("out/notes.txt", "mine");

    let (code, reported) = run(&[]);
    assert_eq!(code, Some(2), "{reported}");
    assert!(reported.contains(&format!("{name} (not written by this program)")), "{reported}");
    assert!(reported.contains("help: give another folder, or --force"), "{reported}");
    assert_eq!(listing(&folder.path("out")).len(), 2, "nothing is written, nothing staged is left");
    assert_eq!(fs::read_to_string(folder.path(&format!("out/{name}"))).expect("kept"), FOREIGN);

    let (code, reported) = run(&["--force"]);
    assert!(matches!(code, Some(0 | 1)), "{reported}");
    assert_ne!(fs::read(folder.path(&format!("out/{name}"))).expect("replaced"), FOREIGN.as_bytes());
    assert_eq!(fs::read_to_string(folder.path("out/notes.txt")).expect("kept"), "mine");

    let (code, reported) = run(&[]);
    assert!(matches!(code, Some(0 | 1)), "its own files may be replaced: {reported}");
    folder.edit(&format!("out/{name}"), |text| format!("{text} edited"));
    let (code, reported) = run(&[]);
    assert_eq!(code, Some(2), "{reported}");
    assert!(reported.contains(&format!("{name} (changed since it was written)")), "{reported}");
}

#[test]
fn a_study_respects_what_is_there() {
    respects(&["study.toml", "--quiet"], "table.csv");
    respects(&["study.toml", "--quiet"], "bias-efficient.svg");
}

#[test]
fn gap_respects_what_is_there() {
    respects(&["gap", "rig.toml"], "verdict.txt");
}

#[test]
fn identify_respects_what_is_there() {
    respects(&["identify", "rig.toml"], "borders.svg");
}

#[test]
fn rig_respects_measurements() {
    respects(&["rig", "--seed", "7"], "rig.toml");
    respects(&["rig", "--seed", "7"], "drive.csv");
}

#[test]
fn design_respects_measurements() {
    let plan =
        ["design", "--order", "1", "--points", "3", "--interval", "-1,1", "--rate", "100", "--periods", "5"];
    respects(&plan, "rig.toml");
    respects(&plan, "descendant.csv");
}

/// Whose a single file is nobody can show: it is replaced by force only.
#[test]
fn init_and_simulate_respect_what_is_there() {
    let folder = Folder::with_good_rig();
    folder.switchback(&["identify", "rig.toml", "--quiet", "--out", "found"]).assert().success();
    for arguments in [
        &["init", "again.csv", "--out", "file"][..],
        &["simulate", "found/model.json", "again.csv", "--out", "file"],
    ] {
        folder.write("file", FOREIGN);
        let run = folder.switchback(arguments).assert().code(2);
        let reported = String::from_utf8_lossy(&run.get_output().stderr).into_owned();
        assert!(reported.contains("file: is there already") && reported.contains("--force"), "{reported}");
        assert_eq!(fs::read_to_string(folder.path("file")).expect("kept"), FOREIGN);
        folder.switchback(arguments).arg("--force").assert().success();
        assert_ne!(fs::read_to_string(folder.path("file")).expect("replaced"), FOREIGN);
    }
}

#[test]
fn man_respects_what_is_there() {
    respects(&["man"], "switchback.1");
}

#[test]
fn compare_respects_what_is_there() {
    let folder = Folder::with_good_rig();
    folder.write("study.toml", STUDY);
    folder.switchback(&["study.toml", "--quiet", "--out", "report"]).assert().success();
    fs::create_dir(folder.path("out")).expect("a new folder");
    folder.write("out/comparison.txt", FOREIGN);
    let compare = |more: &[&str]| {
        folder.switchback(&["compare", "report", "report", "--quiet", "--out", "out"]).args(more).assert()
    };
    let reported = compare(&[]).code(2).get_output().stderr.clone();
    assert!(String::from_utf8_lossy(&reported).contains("comparison.txt (not written by this program)"));
    assert_eq!(fs::read_to_string(folder.path("out/comparison.txt")).expect("kept"), FOREIGN);
    compare(&["--force"]).success();
    compare(&[]).success();
}

/// Nothing is diagnosed: what is there is refused before.
#[test]
fn an_examination_respects_reports_keys_and_journals_of_others() {
    let folder = Folder::with_good_rig();
    folder.write("blind.toml", BLIND);
    for (name, reported) in [
        ("answers.csv", "answers.csv (not written by this program)"),
        ("key.jsonl", "key.jsonl (not written by this program)"),
        ("unfinished.jsonl", "something else wrote it"),
    ] {
        fs::create_dir(folder.path(name)).expect("a new folder");
        folder.write(&format!("{name}/{name}"), FOREIGN);
        let run = folder.switchback(&["blind.toml", "--quiet", "--out", name]).assert().code(2);
        let stderr = String::from_utf8_lossy(&run.get_output().stderr).into_owned();
        assert!(stderr.contains(reported) && stderr.contains("help: "), "{stderr}");
        assert_eq!(listing(&folder.path(name)), [name]);
        assert_eq!(fs::read_to_string(folder.path(&format!("{name}/{name}"))).expect("kept"), FOREIGN);
    }
}

#[test]
fn what_a_former_diagnosis_left_is_removed() {
    let folder = Folder::with_good_rig();
    let run = |arguments: &[&str]| {
        let output = folder.switchback(arguments).output().expect("it runs");
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    };
    run(&["identify", "rig.toml", "--out", "out"]);
    let first = listing(&folder.path("out"));
    let figure = "measured_and_simulated_again.svg";
    assert!(first.iter().any(|name| name == figure), "{first:?}");
    folder.edit("rig.toml", |text| text.replace("again.csv", "anew.csv"));
    fs::copy(folder.path("again.csv"), folder.path("anew.csv")).expect("a copy");
    folder.write("out/notes.txt", "mine");
    run(&["identify", "rig.toml", "--out", "out"]);
    let second = listing(&folder.path("out"));
    assert!(!second.iter().any(|name| name == figure), "{second:?}");
    assert!(second.iter().any(|name| name == "notes.txt"), "{second:?}");
    assert_eq!(second.len(), first.len() + 1, "{second:?}");
}

#[test]
fn a_verdict_that_is_written_leads_to_the_file_beside_it() {
    let folder = Folder::with_good_rig();
    // Of records that nobody designed nothing separates a play from a gradual transition: an experiment would.
    let bench = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/data/bench.csv");
    let output = folder.switchback(&["gap", bench, "--out", "out"]).output().expect("it runs");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(!String::from_utf8_lossy(&output.stdout).contains("--out"));
    assert!(folder.path("out/next_experiment.csv").exists());
    let verdict = fs::read_to_string(folder.path("out/verdict.txt")).expect("a verdict").replace('\n', " ");
    assert!(verdict.contains("its input is in next_experiment.csv"), "{verdict}");
    assert!(!verdict.contains("--out"), "{verdict}");
}

#[test]
fn nothing_that_is_read_is_written() {
    let folder = Folder::with_good_rig();
    folder.write("m.csv", &fs::read_to_string(folder.path("again.csv")).expect("a record"));
    fs::copy(folder.path("m.csv"), folder.path("series.csv")).expect("a copy");
    let measured = fs::read_to_string(folder.path("m.csv")).expect("a record");
    let refused = |arguments: &[&str], name: &str| {
        let output = folder.switchback(arguments).output().expect("it runs");
        let reported = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{reported}");
        assert!(reported.contains("is read by this command") && reported.contains("help: "), "{reported}");
        assert_eq!(fs::read_to_string(folder.path(name)).expect("kept"), measured);
    };
    refused(&["init", "m.csv", "--out", "m.csv", "--force"], "m.csv");
    refused(&["init", "m.csv", "--out", "./m.csv", "--force"], "m.csv");
    refused(&["identify", "series.csv", "--out", ".", "--force"], "series.csv");
    let output = folder.switchback(&["identify", "rig.toml", "--out", "found"]).output().expect("it runs");
    assert_eq!(output.status.code(), Some(0));
    refused(&["simulate", "found/model.json", "m.csv", "--out", "m.csv", "--force"], "m.csv");
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(folder.path("m.csv"), folder.path("link.csv")).expect("a link");
        refused(&["init", "link.csv", "--out", "m.csv", "--force"], "m.csv");
    }
}

#[test]
fn the_folder_of_a_new_file_is_made() {
    let folder = Folder::with_good_rig();
    let init = |out: &str| folder.switchback(&["init", "again.csv", "--out", out]).output().expect("it runs");
    assert_eq!(init("deep/down/r.toml").status.code(), Some(0));
    let again = folder.switchback(&["gap", "deep/down/r.toml", "--quiet"]).output().expect("it runs");
    assert_eq!(again.status.code(), Some(0), "{}", String::from_utf8_lossy(&again.stderr));
    let refused = init("again.csv/r.toml");
    let reported = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert_eq!(refused.status.code(), Some(2));
    assert!(
        reported.contains("again.csv is a file, not a folder") && !reported.contains("os error"),
        "{reported}"
    );
}
