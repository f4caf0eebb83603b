//! What a method of others does by accident: counted, shown, and nothing of it left.
#![cfg(target_os = "linux")]

use super::protocol::{GOOD, shell};
use super::study;
use crate::common::{Folder, listing};
use std::fs;
use std::path::PathBuf;
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};
use switchback_study::results::{self, Cell};

/// A folder for what is temporary, in which nothing may be left.
struct Place(Folder);

impl Place {
    fn new(answer: &str) -> Self {
        let place = Self(Folder::with_good_rig());
        fs::create_dir(place.0.path("temporary")).expect("a folder");
        place.0.write("estimator.sh", &shell("1", answer));
        let text = study(&["sh", "estimator.sh"], "patience = 1\nantithetic = false");
        place.0.write("study.toml", &text.replace("[200, 1000]", "[200]"));
        place
    }

    fn temporary(&self) -> PathBuf {
        fs::canonicalize(self.0.path("temporary")).expect("a folder")
    }

    fn command(&self) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_switchback"));
        command.args(["study.toml", "--quiet", "--out", "out"]).current_dir(self.0.path("."));
        command.env("TMPDIR", self.temporary()).stdout(Stdio::null()).stderr(Stdio::piped());
        command
    }

    /// Runs the study to its end.
    fn run(&self) -> (Output, Cell) {
        let output = self.command().output().expect("it runs");
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        let results = results::read(&self.0.path("out")).expect("results");
        (output, results.cells.last().expect("a cell").clone())
    }

    /// Processes that were begun with this place's temporary folder in their environment.
    fn processes(&self) -> Vec<String> {
        let place = self.temporary().display().to_string();
        let mut found = Vec::new();
        for entry in fs::read_dir("/proc").expect("/proc").flatten() {
            let of = |file: &str| fs::read(entry.path().join(file)).unwrap_or_default();
            if String::from_utf8_lossy(&of("environ")).contains(&place) {
                found.push(String::from_utf8_lossy(&of("cmdline")).replace('\0', " "));
            }
        }
        found
    }

    #[track_caller]
    fn nothing_is_left(&self, within: Duration) {
        let begun = Instant::now();
        let left = || (self.processes(), listing(&self.temporary()));
        while left() != (Vec::new(), Vec::new()) && begun.elapsed() < within {
            sleep(Duration::from_millis(5));
        }
        assert_eq!(left(), (Vec::new(), Vec::new()));
    }

    fn wait_for(&self, name: &str, process: &mut Child) {
        let begun = Instant::now();
        while !self.0.path(name).exists() {
            assert!(process.try_wait().expect("ours").is_none(), "it ended before");
            assert!(begun.elapsed() < Duration::from_secs(60), "{name} does not come");
            sleep(Duration::from_millis(5));
        }
    }
}

/// What happens at each of these replicates.
const ACCIDENTS: [(usize, &str, &str); 11] = [
    (3, "exit 3", "it ended before its answer (exit status: 3)"),
    (5, "kill -9 $$", "it ended before its answer (signal: 9 (SIGKILL))"),
    (8, "sleep 1000", "no answer within 1 s"),
    (9, "echo warning: singular", "it printed `warning: singular`, which is no answer"),
    (12, "echo \"{\\\"id\\\":$id,\\\"estimate\\\":[1,2]}\"; continue", "it gave 2 estimates of 8 parameters"),
    (
        15,
        "echo \"{\\\"id\\\":$id,\\\"estimate\\\":[1,NaN,3,4,5,6,7,8]}\"; continue",
        "its estimate of b1 is no number",
    ),
    (16, "echo \"{\\\"id\\\":$id,\\\"failed\\\":\\\"not  converged\\\"}\"; continue", "not converged"),
    (
        20,
        "echo \"{\\\"id\\\":$id,\\\"estimate\\\":[1,2,3,4,5,6,7,8],\\\"se\\\":[-1,1,1,1,1,1,1,1]}\"; continue",
        "its standard error of a1 is negative",
    ),
    (21, "echo \"{\\\"id\\\":$id}\"; continue", "its answer has neither `estimate` nor `failed`"),
    (27, "echo it breaks >&2; kill -SEGV $$", "it said: it breaks"),
    (33, "echo '{\"id\":999999,\"failed\":\"x\"}'", "which is no answer"),
];

#[test]
fn every_accident_fails_its_own_replicate_and_no_other() {
    let cases: Vec<String> = ACCIDENTS.iter().map(|(r, what, _)| format!("{r}) {what};;")).collect();
    let place = Place::new(&format!("case $r in\n{}\nesac\n{GOOD}", cases.join("\n")));
    let (_, cell) = place.run();
    let numbers: Vec<usize> = ACCIDENTS.iter().map(|(r, ..)| *r).collect();
    assert_eq!((cell.replicates, &cell.failures.replicates), (40, &numbers), "{:?}", cell.failures);
    for ((_, what, wanted), reason) in ACCIDENTS.iter().zip(&cell.failures.reasons) {
        assert!(reason.contains(wanted), "{what}: {reason}");
    }
    let table = fs::read_to_string(place.0.path("out/table.csv")).expect("a table");
    let row = table.lines().find(|line| line.contains(",theirs,")).expect("a row");
    assert!(row.contains(",200,40,11,a1,"), "{row}");
    let page = fs::read_to_string(place.0.path("out/index.html")).expect("a page");
    assert!(page.contains("40 − 11"));
    place.nothing_is_left(Duration::ZERO);
}

#[test]
fn a_method_that_never_answers_leaves_a_study_without_its_estimates() {
    let place = Place::new("exit 1");
    let (_, cell) = place.run();
    assert_eq!((cell.replicates, cell.failures.count), (40, 40));
    assert!(cell.parameters.iter().all(|p| p.bias.is_none() && p.sd.is_none()));
    let words = fs::read_to_string(place.0.path("out/index.html")).expect("a page");
    assert!(words.contains("theirs"));
    place.nothing_is_left(Duration::ZERO);
}

#[test]
fn what_a_method_begins_does_not_outlive_the_study() {
    let place = Place::new(&format!("[ $r = 4 ] && setsid sleep 1000 & \n{GOOD}"));
    let (_, cell) = place.run();
    assert_eq!(cell.failures.count, 0, "{:?}", cell.failures);
    place.nothing_is_left(Duration::ZERO);
}

#[test]
fn noise_without_end_ends_with_patience() {
    let place = Place::new(&format!("[ $r = 6 ] && yes\n{GOOD}"));
    let (output, cell) = place.run();
    assert_eq!(cell.failures.replicates, [6], "{:?}", cell.failures);
    assert_eq!(cell.failures.reason.as_deref(), Some("it printed `y`, which is no answer"));
    assert!(output.stderr.len() < 3000);
    place.nothing_is_left(Duration::ZERO);
}

#[test]
fn a_signal_to_the_study_ends_its_methods_and_keeps_what_was_finished() {
    for (signal, code) in [("-TERM", Some(3)), ("-KILL", None)] {
        let place = Place::new(&format!("[ $r = 20 ] && touch stands && sleep 1000\n{GOOD}"));
        let text = fs::read_to_string(place.0.path("study.toml")).expect("a study");
        place.0.write("study.toml", &text.replace("patience = 1", "patience = 1000"));
        let mut process = place.command().spawn().expect("it starts");
        place.wait_for("stands", &mut process);
        let sent = Command::new("kill").args([signal, &process.id().to_string()]).status();
        assert!(sent.expect("kill").success());
        assert_eq!(process.wait().expect("it ends").code(), code);
        place.nothing_is_left(Duration::from_secs(10));
        assert!(!place.0.path("out/results.json").exists());
    }
}
