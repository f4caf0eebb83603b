//! A field examination of made bases, from its scenario to its report.

mod common;

use common::{Folder, listing};
use std::fs;

const FIELD: &str = r#"study = "field"
question = "?"
seed = 4
effects = ["sensor_drift", "backlash"]
sizes = [2.0]
seeds = 1
made = 2
none = 1
outside = 1
slice = 8
"#;

/// Runs, and gives the exit code with what is told.
fn run(folder: &Folder, arguments: &[&str]) -> (Option<i32>, String) {
    let output = folder.switchback(arguments).output().expect("it runs");
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn parts_merged_are_the_bytes_of_one_run() {
    let folder = Folder::with_good_rig();
    folder.write("field.toml", FIELD);
    let (code, told) = run(&folder, &["field.toml", "--quiet", "--out", "whole"]);
    assert_eq!(code, Some(0), "{told}");
    for part in ["1", "2"] {
        let shard = format!("{part}/2");
        let arguments = ["field.toml", "--shard", &shard, "--threads", "1", "--quiet", "--out", part];
        assert_eq!(run(&folder, &arguments).0, Some(0));
        assert!(!folder.path(part).join("unfinished.jsonl").exists());
    }
    let (code, told) = run(&folder, &["merge", "2", "1", "--quiet", "--out", "merged"]);
    assert_eq!(code, Some(0), "{told}");
    let files = listing(&folder.path("whole"));
    for file in ["answers.csv", "cases.jsonl", "key.jsonl", "results.json", "summary.md"] {
        assert!(files.iter().any(|name| name == file), "{file} is missing in {files:?}");
    }
    assert_eq!(listing(&folder.path("merged")), files);
    for file in &files {
        let [one, other] = ["whole", "merged"].map(|f| fs::read(folder.path(f).join(file)).expect("a file"));
        assert!(one == other, "{file} differs");
    }

    // Every rig is diagnosed with the model and without.
    let answers = fs::read_to_string(folder.path("whole/answers.csv")).expect("a table");
    let with_model = |told: &str| answers.lines().filter(|line| line.contains(&format!(",{told},"))).count();
    assert_eq!(answers.lines().count(), 1 + 8, "{answers}");
    assert!(with_model("true") >= 4, "{answers}");
    let summary = fs::read_to_string(folder.path("whole/summary.md")).expect("a page");
    assert!(summary.contains("NO MEASURED BASE"), "{summary}");
}

#[test]
fn what_cannot_be_examined_is_refused_in_one_message() {
    let folder = Folder::with_good_rig();
    let refused = |text: &str, words: &[&str]| {
        folder.write("field.toml", text);
        let (code, told) = run(&folder, &["field.toml", "--quiet", "--out", "none"]);
        assert_eq!(code, Some(2), "{told}");
        for word in words {
            assert!(told.contains(word), "`{word}` is missing in: {told}");
        }
        assert!(!folder.path("none").exists());
    };
    refused(&FIELD.replace("[2.0]", "[1.0]"), &["field.toml:5:9", "no size reaches 2"]);
    refused(&FIELD.replace("backlash", "backlsh"), &["did you mean `backlash`?"]);
    let nowhere = FIELD.replace("made = 2", "rigs = \"nowhere\"\nmade = 0");
    refused(&nowhere, &["nowhere: holds no measured rig"]);
    let (code, told) = run(&folder, &["field.toml", "--engine", "direct"]);
    assert_eq!((code, told.contains("has no engines")), (Some(2), true), "{told}");
}

#[test]
fn a_folder_that_is_not_there_is_told_and_made_ones_in_it_are_left_out() {
    let folder = Folder::with_good_rig();
    folder.write("field.toml", &FIELD.replace("made = 2", "rigs = \"nowhere\"\nmade = 0"));
    let (_, told) = run(&folder, &["field.toml", "--out", "none"]);
    assert!(told.contains("NO MEASURED BASES: the folder nowhere exists neither"), "{told}");
    // Only the good rig is left of what is copied into the folder, and it is no made one.
    folder.switchback(&["rig", "--seed", "3", "--out", "rigs/made-3"]).assert().success();
    folder.write("field.toml", &FIELD.replace("made = 2", "rigs = \"rigs\"\nmade = 0"));
    let (code, told) = run(&folder, &["field.toml", "--out", "none"]);
    assert_eq!((code, told.contains("rigs: holds no measured rig")), (Some(2), true), "{told}");
}
