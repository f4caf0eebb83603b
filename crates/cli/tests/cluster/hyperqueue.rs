//! HyperQueue with three workers. Its program `hq` is taken where it is on the PATH; or else `hq.py` speaks its command line to the server and
//! the workers of the Python package, with the interpreter that `SWITCHBACK_HYPERQUEUE` names.

use super::Cluster;
use super::processes::{descendants, kill};
use super::study::is_asked;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

pub(crate) struct HyperQueue {
    folder: PathBuf,
    server: Child,
    workers: Vec<Child>,
}

impl HyperQueue {
    fn command(&self, arguments: &[&str]) -> Child {
        let command = &mut Command::new("hq");
        command.args(arguments).envs(self.environment()).stdin(Stdio::null()).stdout(Stdio::null());
        command.spawn().expect("hq starts")
    }

    /// The folder by which the server that is up is found.
    fn current(&self) -> Option<PathBuf> {
        let current = fs::canonicalize(self.folder.join("server/hq-current")).ok()?;
        current.join("access.json").exists().then_some(current)
    }

    fn start_all(&mut self) {
        let before = self.current();
        self.server = self.command(&["server", "start"]);
        while self.current().is_none() || self.current() == before {
            sleep(Duration::from_millis(50));
        }
        self.workers = (0..3).map(|_| self.command(&["worker", "start", "--cpus", "1"])).collect();
    }

    fn end_all(&mut self) {
        for process in self.workers.iter_mut().chain([&mut self.server]) {
            let _ = process.kill();
            let _ = process.wait();
        }
    }
}

impl Cluster for HyperQueue {
    const OPTION: &'static str = "--hq";
    /// The package keeps no journal, and `hq` is started without one.
    const FORGETS: bool = true;

    fn start(scratch: &Path) -> Option<Self> {
        if !is_asked() {
            return None;
        }
        let folder = scratch.to_owned();
        fs::create_dir_all(folder.join("bin")).expect("a folder");
        if Command::new("hq").arg("--version").output().is_err() {
            let Ok(python) = std::env::var("SWITCHBACK_HYPERQUEUE") else {
                eprintln!(
                    "SKIPPED: no `hq` is on the PATH, and SWITCHBACK_HYPERQUEUE names no Python that has the package hyperqueue"
                );
                return None;
            };
            let (hq, stand_in) =
                (folder.join("bin/hq"), concat!(env!("CARGO_MANIFEST_DIR"), "/tests/cluster/hq.py"));
            fs::write(&hq, format!("#!/bin/bash\nexec '{python}' '{stand_in}' \"$@\"\n"))
                .expect("a new file");
            fs::set_permissions(&hq, fs::Permissions::from_mode(0o755)).expect("it is ours");
        }
        let nothing = Command::new("true").spawn().expect("it starts");
        let mut cluster = Self { folder, server: nothing, workers: Vec::new() };
        cluster.start_all();
        Some(cluster)
    }

    fn environment(&self) -> Vec<(&'static str, String)> {
        let path = std::env::var("PATH").unwrap_or_default();
        vec![
            ("HQ_SERVER_DIR", self.folder.join("server").display().to_string()),
            ("PATH", format!("{}:{path}", self.folder.join("bin").display())),
        ]
    }

    fn kill_a_busy_worker(&mut self) -> bool {
        let runs_a_part = |worker: &Child| descendants(worker.id()).iter().any(|p| p.name == "switchback");
        let Some(busy) = self.workers.iter().find(|worker| runs_a_part(worker)) else { return false };
        // What it runs is not killed by the test: it must not outlive the worker.
        kill(busy.id());
        true
    }

    fn restart_coordinator(&mut self) {
        self.end_all();
        self.start_all();
    }
}

/// The script with its time limit in the first job alone: where much else runs, a part may not come to the end of a batch in a second.
pub(crate) fn in_the_first_turn(script: &str) -> String {
    let changed = script.replace("seconds=1\n", "seconds=$([ \"${HQ_JOB_ID:-1}\" -gt 1 ] || echo 1)\n");
    assert_ne!(script, changed);
    changed
}

impl Drop for HyperQueue {
    fn drop(&mut self) {
        self.end_all();
    }
}
