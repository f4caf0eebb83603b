//! Pipes, FIFOs, devices and the standard input in place of files.
#![cfg(unix)]

use crate::common::bench_data::{lines, point};
use crate::common::{Folder, STUDY, listing};
use std::fs::OpenOptions;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

fn table() -> String {
    std::iter::once("time [s],travel,force".to_owned())
        .chain(lines(",", point))
        .map(|line| line + "\n")
        .collect()
}

/// A folder with a record and a FIFO.
fn folder() -> Folder {
    let folder = Folder::with_good_rig();
    folder.write("bench.csv", &table());
    let made = Command::new("mkfifo").arg(folder.path("fifo")).status().expect("mkfifo");
    assert!(made.success());
    folder
}

fn bash(folder: &Folder, line: &str) -> (Option<i32>, String, String) {
    let line = line.replace("switchback", env!("CARGO_BIN_EXE_switchback"));
    let output = Command::new("bash")
        .args(["-c", &line])
        .current_dir(folder.path("."))
        .stdin(Stdio::null())
        .output()
        .expect("bash runs");
    let [out, err] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).expect("UTF-8"));
    (output.status.code(), out, err)
}

#[test]
fn a_stream_is_as_good_as_the_file() {
    let folder = folder();
    let (code, file, reported) = bash(&folder, "switchback identify bench.csv --json");
    assert_eq!(code, Some(0), "{reported}");
    // Names are the file's; all else is the same.
    for (line, name) in [
        ("switchback identify - --json < bench.csv", "stdin"),
        ("cat bench.csv | switchback identify /dev/stdin --json", "stdin"),
        ("switchback identify <(cat bench.csv) --json", "stream"),
        ("(cat bench.csv > fifo) & switchback identify fifo --json", "fifo"),
    ] {
        let (code, stream, reported) = bash(&folder, line);
        assert_eq!(code, Some(0), "{line}: {reported}");
        assert_eq!(stream.replace(name, "bench"), file, "{line}");
    }
}

#[test]
fn rig_files_scenarios_and_models_come_by_streams_too() {
    let folder = folder();
    let (code, file, _) = bash(&folder, "switchback identify rig.toml --json");
    assert_eq!(code, Some(0));
    let (code, stream, reported) = bash(&folder, "switchback identify <(cat rig.toml) --json");
    assert_eq!((code, stream), (Some(0), file), "{reported}");

    folder.write("stdin.toml", STUDY);
    assert_eq!(bash(&folder, "switchback stdin.toml --quiet --out one").0, Some(0));
    let (code, _, reported) = bash(&folder, "switchback - --quiet --out other < stdin.toml");
    assert_eq!(code, Some(0), "{reported}");
    let read = |place: &str| std::fs::read_to_string(folder.path(place)).expect("a report");
    assert_eq!(listing(&folder.path("one")), listing(&folder.path("other")));
    assert_eq!(
        read("one/results.json").replace("switchback stdin.toml", "switchback -"),
        read("other/results.json")
    );

    let line = "switchback identify rig.toml --quiet --out made && switchback simulate <(cat made/model.json) descendant.csv";
    let (code, _, reported) = bash(&folder, line);
    assert_eq!(code, Some(0), "{reported}");
}

#[test]
fn a_silent_stream_is_given_up_and_not_asked_twice() {
    let folder = folder();
    for verb in ["gap", ""] {
        let start = Instant::now();
        let (code, _, reported) = bash(&folder, &format!("switchback {verb} ./fifo"));
        assert_eq!(code, Some(2), "{reported}");
        assert!(
            reported.contains("fifo: nothing came for 10 s") && reported.contains("help: "),
            "{reported}"
        );
        assert!(start.elapsed() < Duration::from_secs(19), "{:?}", start.elapsed());
    }
}

#[test]
fn ctrl_c_ends_the_wait_for_a_stream() {
    let folder = folder();
    // Both the opening of a FIFO and the wait for its first byte.
    for has_writer in [false, true] {
        let start = Instant::now();
        let mut process = Command::new(env!("CARGO_BIN_EXE_switchback"))
            .args(["gap", "fifo"])
            .current_dir(folder.path("."))
            .stderr(Stdio::null())
            .spawn()
            .expect("it starts");
        let writer = has_writer.then(|| OpenOptions::new().write(true).open(folder.path("fifo")));
        std::thread::sleep(Duration::from_millis(500));
        let sent = Command::new("kill").args(["-INT", &process.id().to_string()]).status().expect("kill");
        assert!(sent.success());
        assert_eq!(process.wait().expect("it ends").code(), Some(3));
        assert!(start.elapsed() < Duration::from_secs(8));
        drop(writer);
    }
}
