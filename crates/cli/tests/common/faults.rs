//! Runs that are killed, and disks that fail. `SWITCHBACK_FAULTS` is read by builds with debug assertions only.

use crate::common::{Folder, STUDY, listing};
use std::collections::BTreeMap;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};

/// Files of a folder by name, without those that report the run and not of what came out; none where it is not there.
pub(crate) type Files = BTreeMap<String, Vec<u8>>;

/// Files that report the run and not of what came out.
pub(crate) const BESIDE: [&str; 3] = ["provenance.json", "replicates.sums", ".switchback.beside.sha256"];

pub(crate) fn files(folder: &Path) -> Files {
    let names = if folder.exists() { listing(folder) } else { Vec::new() };
    let read = |name: String| (name.clone(), fs::read(folder.join(name)).expect("a file"));
    names.into_iter().filter(|name| !BESIDE.contains(&name.as_str())).map(read).collect()
}

/// Runs to the end: the exit code, and what is reported.
pub(crate) fn run(folder: &Folder, arguments: &[&str], faults: &str) -> (Option<i32>, String) {
    let output = folder.switchback(arguments).env("SWITCHBACK_FAULTS", faults).output().expect("it runs");
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

pub(crate) fn start(folder: &Folder, arguments: &[&str], faults: &str) -> Child {
    Command::new(env!("CARGO_BIN_EXE_switchback"))
        .current_dir(folder.path("."))
        .args(arguments)
        .env("SWITCHBACK_FAULTS", faults)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts")
}

/// Waits until the process pauses and kills it with SIGKILL; false if it ends without a pause.
pub(crate) fn killed_at_its_pause(mut process: Child) -> bool {
    let stderr = BufReader::new(process.stderr.take().expect("piped"));
    let has_paused = stderr.lines().map_while(Result::ok).any(|line| line == "paused");
    if has_paused {
        process.kill().expect("it lives");
    }
    process.wait().expect("it ends");
    has_paused
}

/// The command of [`Change`].
pub(crate) const RUN: [&str; 4] = ["study.toml", "--quiet", "--out", "out"];

/// A study whose report is there, and a change of it whose report is known too.
pub(crate) struct Change {
    pub(crate) folder: Folder,
    pub(crate) old: Files,
    pub(crate) new: Files,
    entries: Vec<String>,
}

impl Change {
    pub(crate) fn new() -> Self {
        let folder = Folder::with_good_rig();
        let changed = STUDY.replace("seed = 3", "seed = 4").replace("\"efficient\"", "\"joint\"");
        let report = |text: &str| {
            folder.write("study.toml", text);
            let (code, reported) = run(&folder, &RUN, "");
            assert_eq!(code, Some(0), "{reported}");
            files(&folder.path("out"))
        };
        let (new, old) = (report(&changed), report(STUDY));
        assert_ne!(new.keys().collect::<Vec<_>>(), old.keys().collect::<Vec<_>>(), "files come or go");
        folder.write("out/notes.txt", "mine");
        folder.write("study.toml", &changed);
        let with_notes = |mut files: Files| {
            files.insert("notes.txt".to_owned(), b"mine".to_vec());
            files
        };
        let entries = folder.listing();
        Self { old: with_notes(old), new: with_notes(new), entries, folder }
    }

    /// Puts the old report back, file by file, and forgets what was begun.
    pub(crate) fn reset(&self) {
        let _ = fs::remove_dir_all(self.folder.path(".switchback-out"));
        let out = self.folder.path("out");
        fs::remove_dir_all(&out).expect("a folder");
        fs::create_dir(&out).expect("a new folder");
        self.old
            .iter()
            .for_each(|(name, bytes)| fs::write(out.join(name), bytes).expect("it can be written"));
    }

    pub(crate) fn now(&self) -> Files {
        files(&self.folder.path("out"))
    }

    /// The same command succeeds after all, and leaves nothing beside the report.
    #[track_caller]
    pub(crate) fn ends_well(&self) {
        let (code, reported) = run(&self.folder, &RUN, "");
        assert_eq!(code, Some(0), "{reported}");
        assert!(self.now() == self.new, "another report than that of an undisturbed run");
        assert_eq!(self.folder.listing(), self.entries);
    }
}
