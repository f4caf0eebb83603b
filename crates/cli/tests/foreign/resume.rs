//! A study with a method of others that is interrupted goes on where it stood, to the bytes of an undisturbed one.
#![cfg(all(unix, debug_assertions))]

use super::with_joint;
use crate::common::Folder;
use crate::common::faults::{files, killed_at_its_pause};
use std::process::{Command, Stdio};

/// Batches for some seconds.
fn text() -> String {
    with_joint("").replace("replicates = 40", "replicates = 1500").replace("[200, 1000]", "[200]")
}

fn command(folder: &Folder, out: &str, faults: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_switchback"));
    command.current_dir(folder.path(".")).args(["study.toml", "--out", out]);
    command.env("SWITCHBACK_FAULTS_WHILE_RUNNING", format!("eager {faults}"));
    command.stdout(Stdio::null()).stderr(Stdio::piped());
    command
}

#[test]
fn what_is_interrupted_goes_on_to_the_same_bytes() {
    let folder = Folder::with_good_rig();
    folder.write("study.toml", &text());
    let whole = command(&folder, "whole", "").output().expect("it runs");
    assert_eq!(whole.status.code(), Some(0), "{}", String::from_utf8_lossy(&whole.stderr));
    let whole = files(&folder.path("whole"));
    let mut continued = 0;
    for call in [4, 9, 13] {
        let _ = std::fs::remove_dir_all(folder.path("out"));
        let process = command(&folder, "out", &format!("pause={call}")).spawn().expect("it starts");
        assert!(killed_at_its_pause(process), "call {call}");
        let output = command(&folder, "out", "").output().expect("it runs");
        let reported = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{reported}");
        continued += usize::from(reported.contains("replicates of a former run are continued"));
        assert!(files(&folder.path("out")) == whole, "killed at call {call}: another report");
    }
    assert_eq!(continued, 3, "nothing was taken up");
}

#[test]
fn sums_of_another_version_of_a_method_are_begun_anew() {
    use super::protocol::{GOOD, shell};
    let folder = Folder::with_good_rig();
    let text = super::study(&["sh", "estimator.sh"], "").replace("replicates = 40", "replicates = 700");
    folder.write("study.toml", &text.replace("[200, 1000]", "[200]"));
    folder.write("estimator.sh", &shell("1.0", GOOD));
    let process = command(&folder, "out", "pause=6").spawn().expect("it starts");
    assert!(killed_at_its_pause(process));
    folder.write("estimator.sh", &shell("1.1", GOOD));
    let output = command(&folder, "out", "").output().expect("it runs");
    let reported = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{reported}");
    assert!(
        reported.contains("another version of a method that the scenario names: begun anew"),
        "{reported}"
    );
}
