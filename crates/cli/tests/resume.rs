//! A study that is killed, or whose disk fails, goes on where it stood: its report has the bytes of an undisturbed one.
#![cfg(all(unix, debug_assertions))]

use crate::common::faults::{Files, files, killed_at_its_pause};
use crate::common::{Folder, STUDY, listing};
use std::fs;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

const RUN: [&str; 4] = ["study.toml", "--quiet", "--out", "out"];

/// Many batches, in a second or two.
fn many() -> String {
    STUDY.replace("replicates = 40", "replicates = 6000")
}

/// Rounds, most cells of which end early.
fn to_a_precision() -> String {
    STUDY.replace(
        "replicates = 40",
        "replicates = 100\nprecision = { sd_relative_mcse = 0.02 }\nmax_replicates = 3000",
    )
}

struct Study {
    folder: Folder,
    whole: Files,
}

impl Study {
    fn new(text: &str) -> Self {
        let folder = Folder::with_good_rig();
        folder.write("study.toml", text);
        let study = Self { whole: Files::new(), folder };
        assert_eq!(study.run(&["study.toml", "--quiet", "--out", "whole"], "").0, Some(0));
        Self { whole: files(&study.folder.path("whole")), ..study }
    }

    fn command(&self, arguments: &[&str], faults: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_switchback"));
        command
            .current_dir(self.folder.path("."))
            .args(arguments)
            .env("SWITCHBACK_FAULTS_WHILE_RUNNING", format!("eager {faults}"));
        command
    }

    fn run(&self, arguments: &[&str], faults: &str) -> (Option<i32>, String) {
        let output = self.command(arguments, faults).output().expect("it runs");
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    }

    fn start(&self, faults: &str) -> Child {
        let mut command = self.command(&RUN, faults);
        command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("the program starts")
    }

    fn is_kept(&self) -> bool {
        self.folder.path("out/unfinished.sums").exists()
    }

    /// The same command goes on, and makes the report of an undisturbed run.
    #[track_caller]
    fn ends_well(&self) {
        let (code, reported) = self.run(&RUN, "");
        assert_eq!(code, Some(0), "{reported}");
        assert!(
            files(&self.folder.path("out")) == self.whole,
            "another report than that of an undisturbed run"
        );
        assert!(!self.is_kept());
    }

    fn reset(&self) {
        let _ = fs::remove_dir_all(self.folder.path("out"));
    }
}

#[test]
fn killed_at_twenty_moments_it_goes_on_to_the_same_report() {
    for text in [many(), to_a_precision()] {
        let study = Study::new(&text);
        let time = Instant::now();
        study.ends_well();
        let time = time.elapsed();
        study.reset();
        let mut kept = 0;
        for kill in 0..20 {
            let mut process = study.start("");
            std::thread::sleep(time.mul_f64(0.2 + f64::from(kill * 7 % 20) / 40.0));
            process.kill().expect("a process that was not waited for");
            process.wait().expect("it ends");
            kept += usize::from(study.is_kept());
            // All of them together may have come to the end.
            if study.folder.path("out/results.json").exists() {
                study.ends_well();
                study.reset();
            }
        }
        assert!(kept > 5, "{kept} of 20 kept something");
        study.ends_well();
    }
}

#[test]
fn killed_at_each_call_of_the_disk_it_loses_one_batch_at_most() {
    let study = Study::new(&many());
    let mut before = 0;
    for call in (1..13).chain([40, 61]) {
        study.reset();
        assert!(killed_at_its_pause(study.start(&format!("pause={call}"))), "call {call}");
        // Writing, its end, renaming: a batch is kept by three calls.
        let (code, reported) = study.run(&["study.toml", "--out", "out"], "");
        assert_eq!(code, Some(0), "{reported}");
        let kept =
            reported.lines().find_map(|line| line.strip_suffix(" replicates of a former run are continued"));
        let kept: usize = kept.map_or(0, |kept| kept.parse().expect("a number"));
        assert!((call > 3) == (kept > 0), "{kept} kept at call {call}");
        assert!(kept >= before, "{kept} kept at call {call}, {before} before");
        before = kept;
        assert!(files(&study.folder.path("out")) == study.whole);
    }
    assert!(before >= 1000, "{before}");
}

#[test]
fn a_disk_that_fails_is_reported_and_nothing_is_lost() {
    let study = Study::new(&many());
    for call in [1, 2, 3, 20, 21] {
        study.reset();
        let (code, reported) = study.run(&RUN, &format!("fail={call}"));
        assert_eq!(code, Some(2), "{reported}");
        assert!(
            reported.contains("cannot keep there") && reported.contains("injected by a test"),
            "{reported}"
        );
        assert_eq!(reported.matches("error: ").count(), 1, "{reported}");
        assert!(!study.folder.path("out/results.json").exists());
        assert_eq!(study.is_kept(), call > 3);
        study.ends_well();
    }
}

#[test]
fn a_full_disk_is_reported_and_nothing_is_lost() {
    let study = Study::new(&many());
    let place = study.folder.path("out");
    let mount = |place: &std::path::Path| {
        fs::create_dir(place).expect("a new folder");
        let mut mount = Command::new("mount");
        mount.args(["-t", "tmpfs", "-o", "size=2m", "none"]).arg(place).stderr(Stdio::null());
        mount.status().is_ok_and(|status| status.success())
    };
    if !mount(&place) {
        eprintln!("SKIPPED: a file system is mounted by root only");
        return;
    }
    struct Mounted(std::path::PathBuf);
    impl Drop for Mounted {
        fn drop(&mut self) {
            let _ = Command::new("umount").arg(&self.0).status();
        }
    }
    let _mounted = Mounted(place.clone());
    fs::write(place.join("ballast"), vec![1; (2 << 20) - (24 << 10)]).expect("there is space");
    let (code, reported) = study.run(&RUN, "");
    assert_eq!(code, Some(2), "{reported}");
    assert!(reported.contains("No space left") && reported.matches("error: ").count() == 1, "{reported}");
    fs::remove_file(place.join("ballast")).expect("it is there");
    study.ends_well();
}

#[test]
fn what_was_stopped_says_that_it_is_partial() {
    let study = Study::new(&many());
    for signal in ["-TERM", "-INT"] {
        study.reset();
        // Long enough to be stopped, and by no more than its number another study.
        let long = many().replace("6000", "6000000");
        study.folder.write("study.toml", &long);
        let process = study.start("");
        let begun = Instant::now();
        while !study.is_kept() {
            assert!(begun.elapsed() < Duration::from_secs(60), "nothing is kept");
            std::thread::sleep(Duration::from_millis(2));
        }
        let sent = Command::new("kill").args([signal, &process.id().to_string()]).status().expect("kill");
        assert!(sent.success());
        let output = process.wait_with_output().expect("it ends");
        assert_eq!(output.status.code(), Some(3), "{}", String::from_utf8_lossy(&output.stderr));
        let table = fs::read_to_string(study.folder.path("out/partial/report.md")).expect("a partial report");
        assert!(table.contains("PARTIAL") && table.contains("of 6000000"), "{table}");
        let results = fs::read_to_string(study.folder.path("out/partial/results.json")).expect("results");
        let results: serde_json::Value = serde_json::from_str(&results).expect("JSON");
        let replicates = results["partial"]["replicates"].as_u64().expect("a number");
        assert_eq!(results["partial"]["of"].as_u64(), Some(6_000_000));
        assert!(!study.folder.path("out/results.json").exists());
        // A number between the two.
        let asked = replicates + 500;
        study.folder.write("study.toml", &many().replace("6000", &asked.to_string()));
        let (code, reported) = study.run(&["study.toml", "--out", "out"], "");
        assert_eq!(code, Some(0), "{reported}");
        assert!(
            reported.contains(&format!("{replicates} replicates of a former run are continued")),
            "{reported}"
        );
        assert!(!study.folder.path("out/partial").exists());
        let (code, reported) = study.run(&["study.toml", "--quiet", "--out", "anew"], "");
        assert_eq!(code, Some(0), "{reported}");
        assert!(files(&study.folder.path("out")) == files(&study.folder.path("anew")));
        fs::remove_dir_all(study.folder.path("anew")).expect("a folder");
    }
}

#[test]
fn more_replicates_are_added_to_those_that_are_there() {
    let study = Study::new(&many());
    let reported = |replicates: &str| {
        study.folder.write("study.toml", &many().replace("6000", replicates));
        let (code, reported) = study.run(&["study.toml", "--out", "out"], "");
        assert_eq!(code, Some(0), "{reported}");
        reported
    };
    // Within a batch, at its end, and the same again.
    for (replicates, kept) in
        [("700", None), ("1001", Some("700")), ("2560", Some("1001")), ("2560", Some("2560"))]
    {
        let reported = reported(replicates);
        let line = reported.lines().find(|line| line.ends_with("replicates of a former run are continued"));
        assert_eq!(line.and_then(|line| line.split(' ').next()), kept, "{reported}");
    }
    study.folder.write("study.toml", &many());
    study.ends_well();
    // Fewer cannot be taken out of a sum.
    let fewer = reported("700");
    assert!(fewer.contains("has more replicates than are asked for: begun anew"), "{fewer}");
}

#[test]
fn what_another_study_left_is_not_mixed_in() {
    let study = Study::new(&many());
    let begin = || {
        study.reset();
        assert!(killed_at_its_pause(study.start("pause=31")));
        assert!(study.is_kept());
    };
    begin();
    study.folder.write("study.toml", &many().replace("seed = 3", "seed = 4"));
    let (code, reported) = study.run(&["study.toml", "--out", "out"], "");
    assert_eq!(code, Some(0), "{reported}");
    assert!(reported.contains("is of another scenario, or another part of it: begun anew"), "{reported}");
    study.folder.write("study.toml", &many());
    // Another name or question is the same study.
    begin();
    let sums = study.folder.path("out/unfinished.sums");
    let mut bytes = fs::read(&sums).expect("sums");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(&sums, &bytes).expect("it can be written");
    let (code, reported) = study.run(&["study.toml", "--out", "out"], "");
    assert_eq!(code, Some(0), "{reported}");
    assert!(reported.contains("is not as it was written: begun anew"), "{reported}");
    assert!(files(&study.folder.path("out")) == study.whole);
    // A file of someone else is not touched.
    study.reset();
    fs::create_dir(study.folder.path("out")).expect("a new folder");
    study.folder.write("out/unfinished.sums", "1 + 1 = 2");
    let (code, reported) = study.run(&RUN, "");
    assert_eq!(code, Some(2), "{reported}");
    assert!(reported.contains("holds something else") && reported.contains("move it away"), "{reported}");
    assert_eq!(listing(&study.folder.path("out")), ["unfinished.sums"]);
}
