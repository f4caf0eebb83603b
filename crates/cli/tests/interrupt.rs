//! A process that is stopped leaves nothing half-written. Signals are sent by `kill`.
#![cfg(unix)]

use crate::common::{BLIND, Folder, STUDY, listing};
use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

fn start(folder: &Folder, arguments: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_switchback"))
        .current_dir(folder.path("."))
        .args(arguments)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts")
}

/// Waits until something holds.
fn until(what: &str, holds: impl Fn() -> bool) {
    let start = Instant::now();
    while !holds() {
        assert!(start.elapsed() < Duration::from_secs(60), "waited in vain for {what}");
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn is_staging(folder: &Path) -> bool {
    folder.exists() && listing(folder).iter().any(|name| name.starts_with(".switchback-"))
}

/// Sends a signal: the exit code, and what is reported.
fn stop(mut process: Child, signal: &str) -> (Option<i32>, String) {
    let sent = Command::new("kill").args([signal, &process.id().to_string()]).status().expect("kill");
    assert!(sent.success());
    let code = process.wait().expect("it ends").code();
    let mut reported = String::new();
    process.stderr.take().expect("piped").read_to_string(&mut reported).expect("UTF-8");
    (code, reported)
}

#[test]
fn a_stopped_study_leaves_the_old_report_as_it_was() {
    for signal in ["-INT", "-TERM", "-HUP"] {
        let folder = Folder::with_good_rig();
        folder.write("study.toml", STUDY);
        folder.switchback(&["study.toml", "--quiet", "--out", "out"]).assert().success();
        // One that would take minutes.
        folder.write("study.toml", &STUDY.replace("replicates = 40", "replicates = 4000000"));
        let out = folder.path("out");
        let before: Vec<_> =
            listing(&out).iter().map(|name| fs::read(out.join(name)).expect("a file")).collect();
        let names = listing(&out);
        let process = start(&folder, &["study.toml", "--quiet", "--out", "out"]);
        until("a staging folder", || is_staging(&folder.path(".")));
        let (code, reported) = stop(process, signal);
        assert_eq!(code, Some(3), "{signal}: {reported}");
        assert!(reported.contains("stopped"), "{reported}");
        // What the replicates so far left behind, and what they amount to, lie beside it.
        let mut now = listing(&out);
        now.retain(|name| name != "partial" && name != "unfinished.sums");
        assert_eq!(now, names, "{signal}");
        assert!(!is_staging(&folder.path(".")), "{signal}");
        let after: Vec<_> = names.iter().map(|name| fs::read(out.join(name)).expect("a file")).collect();
        assert!(before == after, "{signal} changed the old report");
    }
}

#[test]
fn a_stopped_diagnosis_leaves_no_trace() {
    let folder = Folder::with_good_rig();
    folder.switchback(&["rig", "--seed", "3", "--effect", "creep", "--out", "made"]).assert().success();
    let before = folder.listing();
    let process = start(&folder, &["gap", "made/rig.toml", "--out", "deep/new"]);
    until("a staging folder", || is_staging(&folder.path("deep")));
    let (code, reported) = stop(process, "-INT");
    assert_eq!(code, Some(3), "{reported}");
    assert_eq!(folder.listing(), before);
}

#[test]
fn a_stopped_examination_keeps_its_keys_and_every_rig_that_is_judged() {
    let folder = Folder::with_good_rig();
    let blind = |slice: &str| BLIND.replace("seeds = 1", "seeds = 20").replace("slice = 1", slice);
    folder.write("blind.toml", &blind("slice = 3"));
    let arguments = ["blind.toml", "--quiet", "--out", "out"];
    let process = start(&folder, &arguments);
    let journal = folder.path("out/unfinished.jsonl");
    let judged = || fs::read_to_string(&journal).map_or(0, |text| text.matches("\"case\":").count());
    until("the first rig", || judged() > 0);
    let (code, reported) = stop(process, "-TERM");
    assert_eq!(code, Some(3), "{reported}");
    let keys = fs::read_to_string(folder.path("out/unfinished-key.jsonl")).expect("the keys");
    assert_eq!(keys.lines().count(), 3);
    let kept = judged();
    assert!((1..3).contains(&kept), "{kept} rigs are kept");
    assert_eq!(listing(&folder.path("out")), ["partial", "unfinished-key.jsonl", "unfinished.jsonl"]);
    let partial = fs::read_to_string(folder.path("out/partial/results.json")).expect("partial results");
    let partial: serde_json::Value = serde_json::from_str(&partial).expect("JSON");
    assert_eq!(partial["partial"]["of"], 3);
    let summary = fs::read_to_string(folder.path("out/partial/summary.txt")).expect("a summary");
    assert!(summary.starts_with("PARTIAL: the examination was stopped after "), "{summary}");
    // The same command goes on, and the report is that of an undisturbed run.
    folder.switchback(&arguments).assert().success();
    folder.switchback(&["blind.toml", "--quiet", "--out", "whole"]).assert().success();
    let report = |out: &str| {
        let names = listing(&folder.path(out));
        let names = names.into_iter().filter(|name| name != "provenance.json" && !name.contains("beside"));
        names.map(|name| (fs::read(folder.path(out).join(&name)).expect("a file"), name)).collect::<Vec<_>>()
    };
    assert!(report("out") == report("whole"));
}
