//! Scripts for schedulers; on a real Slurm where one is.
#![cfg(unix)]

use crate::common::faults::{files, run};
use crate::common::{Folder, STUDY};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::process::{Command, Stdio};
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
        let (code, reported) = run(&folder, arguments, "");
        assert_eq!(code, Some(2), "{reported}");
        assert!(reported.contains(words), "`{words}` is missing in: {reported}");
    };
    refused(&["launch", "study.toml"], "--slurm");
    refused(&["launch", "none.toml", "--slurm"], "none.toml");
    refused(&["launch", "study.toml", "--slurm", "--tasks", "0"], "0");
}

#[test]
fn a_script_for_hyperqueue_is_printed_for_a_person_to_read() {
    let folder = Folder::with_good_rig();
    folder.write("study.toml", STUDY);
    let arguments = ["launch", "study.toml", "--hq", "--tasks", "7", "--time", "0:20", "--cpus", "2"];
    let output = folder.switchback(&arguments).output().expect("it runs");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let script = String::from_utf8(output.stdout).expect("UTF-8");
    let first = "# study in 7 parts. Written by `switchback launch study.toml --hq --tasks 7 --cpus 2 --time 0:20`; change it as you \
                 like, and run it where `hq` is.";
    for line in ["#!/bin/bash", first, "parts=7", "options=('--cpus=2')", "threads=2", "seconds=20"] {
        assert!(script.lines().any(|found| found == line), "`{line}` is missing in: {script}");
    }
    folder.write("launch.sh", &script);
    let missing = |expected: &str| {
        let reported =
            Command::new("bash").arg(folder.path("launch.sh")).args(["missing", "1"]).output().expect("bash");
        assert_eq!(
            String::from_utf8_lossy(&reported.stdout),
            expected,
            "{}",
            String::from_utf8_lossy(&reported.stderr)
        );
    };
    missing("1-7\n");
    for number in [1, 4, 6, 7] {
        let part = folder.path(&format!("reports/study-parts/round-1/part-{number}"));
        fs::create_dir_all(&part).expect("a folder");
        fs::write(part.join("part.json"), "").expect("a file");
    }
    missing("2-3,5\n");
}

/// Slurm signals a part its end, then again with all others of the job; what stands in for programs takes its time.
#[test]
fn a_part_reported_twice_that_its_time_is_up_goes_back_into_the_queue() {
    let folder = Folder::with_good_rig();
    folder.write("study.toml", STUDY);
    let output =
        folder.switchback(&["launch", "study.toml", "--slurm", "--tasks", "2"]).output().expect("it runs");
    let script = String::from_utf8(output.stdout).expect("UTF-8");
    let stand_in = |name: &str, text: &str| {
        folder.write(name, &format!("#!/bin/bash\n{text}\n"));
        fs::set_permissions(folder.path(name), fs::Permissions::from_mode(0o755)).expect("it is ours");
    };
    stand_in(
        "part",
        "trap 'echo reported >> part-reported; sleep 0.3; exit 3' TERM; touch part-begun; while :; do sleep 0.02; done",
    );
    // Renamed once it is whole: whoever waits for the file reads all of it.
    stand_in("scontrol", "touch asked; sleep 0.3; echo \"$@\" > requeued.new; mv requeued.new requeued");
    let ours = script.lines().map(|line| match line.starts_with("switchback=") {
        true => format!("switchback={}", folder.path("part").display()),
        false => line.to_owned(),
    });
    folder.write("launch.sh", &ours.collect::<Vec<_>>().join("\n"));
    let path = format!("{}:{}", folder.path(".").display(), std::env::var("PATH").expect("a path"));
    let mut job = Command::new("bash");
    job.args(["launch.sh", "part", "1", "0"]).current_dir(folder.path(".")).env("PATH", path);
    job.envs([("SLURM_ARRAY_TASK_ID", "1"), ("SLURM_JOB_ID", "77")]).stdout(Stdio::null());
    let mut job = job.spawn().expect("bash");
    let id = job.id().to_string();
    let wait_for = |name: &str| {
        let begun = Instant::now();
        while !folder.path(name).exists() {
            assert!(begun.elapsed() < Duration::from_secs(60), "{name} is not there");
            std::thread::sleep(Duration::from_millis(10));
        }
    };
    let signal = || {
        let sent = Command::new("kill").args(["-TERM", &id]).status().expect("kill");
        assert!(sent.success());
    };
    wait_for("part-begun");
    signal();
    wait_for("part-reported");
    signal();
    wait_for("asked");
    signal();
    wait_for("requeued");
    assert_eq!(fs::read_to_string(folder.path("requeued")).expect("a file"), "requeue 77\n");
    // Slurm ends the job once it is back in the queue.
    let begun = Instant::now();
    let ended = loop {
        signal();
        match job.try_wait().expect("a child") {
            Some(status) => break status,
            None => assert!(begun.elapsed() < Duration::from_secs(30), "it does not end"),
        }
        std::thread::sleep(Duration::from_millis(50));
    };
    assert!(!ended.success());
}

#[test]
fn what_no_engine_could_run_is_refused_before_it_is_submitted() {
    let folder = Folder::with_good_rig();
    folder.write("study.toml", STUDY);
    folder.write("wrong.toml", &STUDY.replace("replicates = 40", "replicates = -1"));
    for (arguments, words) in [
        (vec!["study.toml", "--hq", "--slurm"], "--slurm"),
        (vec!["study.toml", "--hq", "--partition", "long"], "--partition"),
        (vec!["study.toml", "--slurm", "--time", "2"], "3 minutes at least"),
        (vec!["study.toml", "--slurm", "--time", "an hour"], "hours:minutes:seconds"),
        (vec!["study.toml", "--hq", "--cpus", "0"], "from 1"),
        (vec!["wrong.toml", "--slurm", "--submit"], "replicates"),
        (vec!["rig.toml", "--slurm", "--submit"], "a rig"),
        (vec!["descendant.csv", "--hq", "--submit"], "data"),
    ] {
        let (code, reported) = run(&folder, &[&["launch"], &arguments[..]].concat(), "");
        assert_eq!(code, Some(2), "{arguments:?}: {reported}");
        assert!(
            reported.contains(words) && reported.matches("error: ").count() == 1,
            "`{words}` is missing in: {reported}"
        );
    }
    assert!(!folder.path("reports").exists());
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
        let (code, reported) = run(&folder, &launch, "");
        assert_eq!(code, Some(0), "{reported}");
        let begun = Instant::now();
        while !folder.path(name).join("results.json").exists() {
            let log = || fs::read_to_string(folder.path(&format!("{name}-parts/round-1/log/merge.txt")));
            assert!(begun.elapsed() < Duration::from_secs(120), "no report: {:?}", log());
            std::thread::sleep(Duration::from_millis(200));
        }
        assert!(files(&folder.path(name)) == files(&folder.path(&whole)), "{name}: another report");
    }
}

#[test]
fn names_and_options_are_words_whatever_they_hold() {
    let names = [
        "a\r\ntouch PWNED\n#",
        "a\n",
        "$(touch PWNED)",
        "`touch PWNED`",
        "a'b",
        "'; touch PWNED; '",
        "\u{1b}[2J",
        "a\u{202e}b",
        "-a",
        "\u{9b}31m",
        "$'\\n'",
        "\\",
        "a b",
        "*",
        "!!",
        "\u{7f}",
    ];
    for (k, name) in names.into_iter().enumerate() {
        let folder = Folder::with_good_rig();
        let file = format!("{name}.toml");
        folder.write(&file, STUDY);
        let (engine, more) = if k % 2 == 0 {
            ("--slurm", format!("--partition={name}"))
        } else {
            ("--hq", "--tasks=24".to_owned())
        };
        let output = folder.switchback(&["launch", engine, &more, "--", &file]).output().expect("it runs");
        assert_eq!(output.status.code(), Some(0), "{name:?}: {}", String::from_utf8_lossy(&output.stderr));
        let script = String::from_utf8(output.stdout).expect("UTF-8");
        let is_obeyed = |c: char| (c.is_control() && c != '\n') || c == '\u{202e}';
        assert!(!script.contains(is_obeyed), "{script}");
        folder.write("launch.sh", &script);
        let in_bash = |arguments: &[&str]| {
            Command::new("bash").args(arguments).current_dir(folder.path(".")).output().expect("bash")
        };
        let missing = in_bash(&["launch.sh", "missing", "1"]);
        assert_eq!(
            String::from_utf8_lossy(&missing.stdout),
            "1-24\n",
            "{}",
            String::from_utf8_lossy(&missing.stderr)
        );
        assert!(!folder.path("PWNED").exists(), "{script}");
        let head = script.split("\n\n").nth(1).expect("its variables");
        let shown = in_bash(&["-c", &format!("{head}\nprintf %s \"$scenario\"")]);
        let given = fs::canonicalize(folder.path(&file)).expect("it is there");
        assert_eq!(String::from_utf8_lossy(&shown.stdout), given.display().to_string());
    }
}
