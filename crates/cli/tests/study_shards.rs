//! Parts of a study make the report of one run, and nothing else does.

use crate::common::faults::{Files, files, killed_at_its_pause, run};
use crate::common::{Folder, STUDY};
use std::fs;

fn text(replicates: &str) -> String {
    STUDY.replace("replicates = 40", replicates)
}

/// Runs all parts of a study, or of its next round.
fn parts(folder: &Folder, of: usize, more: &[&str]) -> Vec<String> {
    let part = |number: usize| {
        let (shard, out) = (format!("{number}/{of}"), format!("part-{number}"));
        let arguments =
            [&["study.toml", "--shard", &shard, "--quiet", "--force", "--out", &out][..], more].concat();
        let (code, reported) = run(folder, &arguments, "");
        assert_eq!(code, Some(0), "{reported}");
        out
    };
    (1..=of).map(part).collect()
}

fn merge(folder: &Folder, parts: &[String], out: &str) -> (Option<i32>, String) {
    let parts = parts.iter().rev().map(String::as_str);
    let arguments: Vec<&str> = ["merge"].into_iter().chain(parts).chain(["--out", out]).collect();
    run(folder, &arguments, "")
}

fn whole(folder: &Folder) -> Files {
    let (code, reported) = run(folder, &["study.toml", "--quiet", "--out", "whole"], "");
    assert_eq!(code, Some(0), "{reported}");
    files(&folder.path("whole"))
}

#[test]
fn parts_of_any_number_are_the_bytes_of_one_run() {
    let folder = Folder::with_good_rig();
    // The last batch is not whole, and of 24 parts some are empty.
    folder.write("study.toml", &text("replicates = 1700"));
    let whole = whole(&folder);
    for of in [1, 3, 7, 24] {
        let out = format!("merged-{of}");
        let (code, reported) = merge(&folder, &parts(&folder, of, &[]), &out);
        assert_eq!(code, Some(0), "{reported}");
        assert!(files(&folder.path(&out)) == whole, "of {of} parts another report");
    }
}

#[test]
fn rounds_towards_a_precision_are_the_bytes_of_one_run() {
    let folder = Folder::with_good_rig();
    let precision = "precision = { sd_relative_mcse = 0.02 }\nmax_replicates = 3000";
    folder.write("study.toml", &text(&format!("replicates = 100\n{precision}")));
    let whole = whole(&folder);
    for of in [1, 3] {
        let _ = fs::remove_dir_all(folder.path("rounds"));
        let mut rounds = 1;
        let mut made = parts(&folder, of, &[]);
        loop {
            let out = format!("rounds-{of}-{rounds}");
            let (code, reported) = merge(&folder, &made, &out);
            if code == Some(0) {
                assert!(files(&folder.path(&out)) == whole, "of {of} parts another report");
                break;
            }
            assert_eq!(code, Some(3), "{reported}");
            assert!(
                reported.contains("not precise enough yet") && reported.contains(&format!("--from {out}")),
                "{reported}"
            );
            made = parts(&folder, of, &["--from", &out]);
            made.push(out);
            rounds += 1;
        }
        assert!(rounds > 1, "one round was enough");
    }
}

#[test]
fn what_makes_no_whole_is_refused() {
    let folder = Folder::with_good_rig();
    folder.write("study.toml", &text("replicates = 700"));
    let made = parts(&folder, 3, &[]);
    let refused = |parts: &[&str], words: &str| {
        let parts: Vec<String> = parts.iter().map(|part| (*part).to_owned()).collect();
        let (code, reported) = merge(&folder, &parts, "none");
        assert_eq!(code, Some(2), "{reported}");
        assert!(
            reported.contains(words) && reported.matches("error: ").count() == 1,
            "`{words}` is missing in: {reported}"
        );
        assert!(!folder.path("none").exists());
    };
    refused(&["part-1", "part-3"], "missing: 2/3");
    refused(&["part-1", "part-3"], "as a job array: --array=2");
    refused(&["part-1"], "--array=2-3");
    refused(&["part-1", "part-2", "part-2", "part-3"], "the same part, 2/3");
    fs::create_dir(folder.path("empty")).expect("a new folder");
    refused(&["part-1", "part-2", "empty"], "empty: holds no part");
    let (code, _) = run(&folder, &["study.toml", "--shard", "3/4", "--quiet", "--out", "of-four"], "");
    assert_eq!(code, Some(0));
    refused(&["part-1", "part-2", "of-four"], "the number of parts differs");
    let other = text("replicates = 700").replace("seed = 3", "seed = 4");
    folder.write("study.toml", &other);
    let (code, _) = run(&folder, &["study.toml", "--shard", "3/3", "--quiet", "--out", "other"], "");
    assert_eq!(code, Some(0));
    refused(&["part-1", "part-2", "other"], "the scenario differs");
    // Another scenario's text, and then another's sums, with the list of hashes taken away.
    for part in &made {
        fs::remove_file(folder.path(part).join(".switchback.sha256")).expect("a list");
        folder.write(&format!("{part}/study.toml"), &other);
    }
    refused(&["part-1", "part-2", "part-3"], "part.json is not of the files beside it");
    for part in &made {
        folder.write(&format!("{part}/study.toml"), &text("replicates = 700"));
    }
    let own = fs::read(folder.path("part-3/replicates.sums")).expect("sums");
    fs::copy(folder.path("other/replicates.sums"), folder.path("part-3/replicates.sums")).expect("a copy");
    refused(&["part-1", "part-2", "part-3"], "is of another scenario");
    fs::write(folder.path("part-3/replicates.sums"), own).expect("it can be written");
    let sums = folder.path("part-2/replicates.sums");
    let mut bytes = fs::read(&sums).expect("sums");
    bytes.truncate(bytes.len() - 8);
    fs::write(&sums, bytes).expect("it can be written");
    refused(&["part-1", "part-2", "part-3"], "is not as it was written");
}

#[test]
fn a_part_that_was_killed_goes_on() {
    let folder = Folder::with_good_rig();
    folder.write("study.toml", &text("replicates = 1700"));
    let made = parts(&folder, 2, &[]);
    let first = files(&folder.path(&made[0]));
    let arguments = ["study.toml", "--shard", "1/2", "--quiet", "--out", "again"];
    let mut process = std::process::Command::new(env!("CARGO_BIN_EXE_switchback"))
        .current_dir(folder.path("."))
        .args(arguments)
        .env("SWITCHBACK_FAULTS_WHILE_RUNNING", "eager pause=7")
        .stderr(std::process::Stdio::piped())
        .spawn()
        .expect("the program starts");
    if cfg!(debug_assertions) {
        assert!(killed_at_its_pause(process));
        assert!(folder.path("again/unfinished.sums").exists());
        let (code, reported) = merge(&folder, &["again".to_owned(), made[1].clone()], "none");
        assert_eq!(code, Some(2), "{reported}");
        assert!(reported.contains("again: holds no part"), "{reported}");
    } else {
        process.wait().expect("it ends");
    }
    let (code, reported) = run(&folder, &arguments, "");
    assert_eq!(code, Some(0), "{reported}");
    assert!(files(&folder.path("again")) == first);
}

/// A part took hours, perhaps: it is lost to no other command, and a bit of its label that flipped is seen, whatever the list of hashes says.
#[test]
fn a_part_is_replaced_by_the_same_part_only_and_its_label_is_whole() {
    let folder = Folder::with_good_rig();
    folder.write("study.toml", &text("replicates = 100"));
    let made = parts(&folder, 2, &[]);
    let before = made.iter().map(|part| files(&folder.path(part))).collect::<Vec<_>>();
    for (arguments, words) in [
        (&["merge", "part-1", "part-2", "--out", "part-1"][..], "holds a part of a study"),
        (&["merge", "part-1", "part-2", "--out", "./part-2/"], "holds a part of a study"),
        (&["merge", "part-1", "part-2", "--out", "part-1", "--force"], "is read by this command"),
        (&["study.toml", "--out", "part-1"], "holds a part of a study"),
        (&["study.toml", "--shard", "2/2", "--out", "part-1"], "holds a part of a study"),
        (&["identify", "rig.toml", "--out", "part-1"], "holds a part of a study"),
    ] {
        let (code, reported) = run(&folder, &[arguments, &["--quiet"]].concat(), "");
        assert_eq!(code, Some(2), "{arguments:?}: {reported}");
        assert!(reported.contains(words), "{arguments:?}: {reported}");
        assert!(
            made.iter().map(|part| files(&folder.path(part))).eq(before.iter().cloned()),
            "{arguments:?}"
        );
    }
    // The same part again.
    let same = ["study.toml", "--shard", "1/2", "--quiet", "--out", "part-1"];
    let (code, reported) = run(&folder, &same, "");
    assert_eq!(code, Some(0), "{reported}");

    fs::remove_file(folder.path("part-1/.switchback.sha256")).expect("a list");
    let label = fs::read(folder.path("part-1/part.json")).expect("a label");
    for at in (0..label.len()).step_by(3) {
        let mut flipped = label.clone();
        flipped[at] ^= 1 << (at % 8);
        fs::write(folder.path("part-1/part.json"), &flipped).expect("it can be written");
        let (code, reported) = merge(&folder, &made, "none");
        assert_eq!(code, Some(2), "byte {at}: {reported}");
    }
}
