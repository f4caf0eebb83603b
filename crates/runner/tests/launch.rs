//! Scripts for schedulers; on a real Slurm where one is.
#![cfg(unix)]

mod common;
#[path = "common/faults.rs"]
mod faults;

use common::{Folder, STUDY};
use faults::{files, run};
use std::fs;
use std::process::Command;
use std::time::{Duration, Instant};

#[test]
fn a_script_for_slurm_is_printed_for_a_person_to_read() {
    let folder = Folder::with_good_rig();
    folder.write("study.toml", STUDY);
    let arguments =
        ["launch", "study.toml", "--slurm", "--tasks", "7", "--time", "1:00:00", "--partition", "long ones"];
    let output = folder.switchback(&arguments).output().expect("it runs");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let script = String::from_utf8(output.stdout).expect("UTF-8");
    let first = "# study in 7 parts. Written by `switchback launch study.toml --slurm --tasks 7 --time 1:00:00 --partition 'long \
                 ones'`; change it as you like, and run it where `sbatch` is.";
    let options = "options=('--time=1:00:00' '--partition=long ones')";
    for line in ["#!/bin/bash", first, "name=study", "parts=7", options] {
        assert!(script.lines().any(|found| found == line), "`{line}` is missing in: {script}");
    }
    // It is bash.
    folder.write("launch.sh", &script);
    let checked = Command::new("bash").arg("-n").arg(folder.path("launch.sh")).status().expect("bash");
    assert!(checked.success());
    let refused = |arguments: &[&str], words: &str| {
        let (code, told) = run(&folder, arguments, "");
        assert_eq!(code, Some(2), "{told}");
        assert!(told.contains(words), "`{words}` is missing in: {told}");
    };
    refused(&["launch", "study.toml"], "--slurm");
    refused(&["launch", "none.toml", "--slurm"], "none.toml");
    refused(&["launch", "study.toml", "--slurm", "--tasks", "0"], "0");
}

/// Whether a Slurm answers.
fn is_slurm_there() -> bool {
    let is_there = Command::new("sinfo").output().is_ok_and(|output| output.status.success());
    if !is_there {
        eprintln!("SKIPPED: no Slurm answers; `SLURM_CONF` names its configuration");
    }
    is_there
}

#[test]
fn what_slurm_merges_are_the_bytes_of_one_run() {
    if !is_slurm_there() {
        return;
    }
    let folder = Folder::with_good_rig();
    let precision = "replicates = 100\nprecision = { sd_relative_mcse = 0.02 }\nmax_replicates = 3000";
    for (name, replicates) in [("plain", "replicates = 1700"), ("rounds", precision)] {
        let study = format!("{name}.toml");
        folder.write(&study, &STUDY.replace("replicates = 40", replicates));
        let whole = format!("{name}-whole");
        assert_eq!(run(&folder, &[&study, "--quiet", "--out", &whole], "").0, Some(0));
        let launch = ["launch", &study, "--slurm", "--tasks", "5", "--out", name, "--submit"];
        let (code, told) = run(&folder, &launch, "");
        assert_eq!(code, Some(0), "{told}");
        let begun = Instant::now();
        while !folder.path(name).join("results.json").exists() {
            let log = || fs::read_to_string(folder.path(&format!("{name}-parts/round-1/log/merge.txt")));
            assert!(begun.elapsed() < Duration::from_secs(120), "no report: {:?}", log());
            std::thread::sleep(Duration::from_millis(200));
        }
        assert!(files(&folder.path(name)) == files(&folder.path(&whole)), "{name}: another report");
    }
}
