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

/// What is read whole, by any verb: a pipe that nobody writes is given up, a device without end refused, and neither is kept in memory.
#[test]
fn no_file_is_waited_for_without_end_or_read_without_end() {
    let folder = folder();
    folder.write("study.toml", STUDY);
    for line in
        ["switchback study.toml --out study --quiet", "switchback identify rig.toml --out found --quiet"]
    {
        assert_eq!(bash(&folder, line).0, Some(0), "{line}");
    }
    assert_eq!(bash(&folder, "switchback study.toml --shard 1/2 --out part --quiet").0, Some(0));
    let mut cases = Vec::new();
    for source in ["fifo", "/dev/zero"] {
        let copy = |name: &str, file: &str| {
            let to = format!("{name}{}-{}", file.len(), source.trim_start_matches('/').replace('/', "-"));
            assert_eq!(bash(&folder, &format!("cp -r {name} {to}")).0, Some(0));
            let place = folder.path(&to).join(file);
            let _where_there_is_none = std::fs::remove_file(&place);
            let source = std::fs::canonicalize(folder.path(source)).expect("it is there");
            std::os::unix::fs::symlink(source, place).expect("a link");
            to
        };
        let report = copy("study", ".switchback.sha256");
        let found = copy("found", ".switchback.beside.sha256");
        let part = copy("part", "replicates.sums");
        let label = copy("part", "part.json");
        cases.extend([
            format!("switchback compare {source} {source}"),
            format!("switchback compare study {source}"),
            format!("switchback replay {source} 0:0"),
            format!("switchback gap rig.toml --fmu {source}"),
            format!("switchback gap rig.toml --model {source}"),
            format!("switchback simulate {source} descendant.csv"),
            format!("switchback export found/model.json --to fmu --library {source} --out a.fmu"),
            format!("switchback report {report}"),
            format!("switchback report {found}"),
            format!("switchback merge {part} --out merged"),
            format!("switchback merge {label} --out merged"),
            format!("switchback identify {source}"),
            format!("switchback {source} --out none"),
        ]);
    }
    let refused = |line: &str| {
        // A stream is read up to 256 MiB, and copied once.
        let (code, out, reported) = bash(&folder, &format!("ulimit -v 1500000; timeout 100 {line}"));
        assert_eq!(code, Some(2), "{line}: {out}{reported}");
        assert!(reported.starts_with("error: ") && reported.contains("help: "), "{line}: {reported}");
    };
    let (fifos, devices): (Vec<&String>, Vec<&String>) = cases.iter().partition(|line| line.contains("fifo"));
    // Each may wait for ten seconds, and needs no memory.
    std::thread::scope(|scope| fifos.into_iter().for_each(|line| drop(scope.spawn(|| refused(line)))));
    // Each may take its memory, and waits for nothing.
    devices.into_iter().for_each(|line| refused(line));
    for line in [
        "switchback identify <(yes 1,2)",
        "switchback compare study <(yes [)",
        "switchback simulate <(yes 1) descendant.csv",
        "switchback - --out none < <(yes '# nothing')",
    ] {
        refused(line);
    }
    assert!(!folder.path("merged").exists() && !folder.path("a.fmu").exists());
}

/// A limit on the size of files is a full disk, not the end of the process.
#[test]
fn a_file_that_grows_beyond_a_limit_leaves_nothing_staged() {
    let folder = folder();
    let before = listing(&folder.path("."));
    let (code, _, reported) = bash(&folder, "ulimit -f 4; switchback identify rig.toml --quiet --out out");
    assert_eq!(code, Some(2), "{reported}");
    assert!(reported.contains("cannot write to this output folder"), "{reported}");
    assert_eq!(listing(&folder.path(".")), before);
}
