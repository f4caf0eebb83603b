//! A study that takes a while, and what becomes of it in parts.

use super::Cluster;
use crate::common::faults::{Files, files, run};
use crate::common::{BLIND, Folder, STUDY};
use std::cell::OnceCell;
use std::fs::{self, File};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

pub(crate) const PARTS: usize = 24;

/// Whether engines are to be started at all: they take minutes, and have tests of their own in `.ci/cluster`.
pub(crate) fn is_asked() -> bool {
    let is_asked = std::env::var_os("SWITCHBACK_CLUSTER").is_some();
    if !is_asked {
        eprintln!("SKIPPED: SWITCHBACK_CLUSTER is not set; .ci/cluster runs parts on Slurm and HyperQueue");
    }
    is_asked
}

/// Whether parts are long, and nothing is left out.
pub(crate) fn is_full() -> bool {
    std::env::var("SWITCHBACK_CLUSTER").is_ok_and(|value| value == "full")
}

pub(super) struct Study {
    pub(crate) folder: Folder,
    whole: OnceCell<Files>,
}

impl Study {
    /// Each part takes about `length` times a third of a second of one processor, ten times as long in the full test.
    pub(crate) fn new(length: usize) -> Self {
        let length = if is_full() { 10 * length } else { length };
        Self::of(&format!("replicates = {}", PARTS * length * 1024), "300_000")
    }

    /// The first of its rounds is not enough.
    pub(crate) fn with_precision() -> Self {
        Self::of(
            "replicates = 3000\nprecision = { sd_relative_mcse = 0.01 }\nmax_replicates = 30_000",
            "2000",
        )
    }

    /// A blind examination of two rigs.
    pub(crate) fn of_two_rigs() -> Self {
        let folder = Folder::with_good_rig();
        folder.write("study.toml", BLIND);
        Self { folder, whole: OnceCell::new() }
    }

    fn of(replicates: &str, samples: &str) -> Self {
        let folder = Folder::with_good_rig();
        let text =
            STUDY.replace("replicates = 40", replicates).replace("[200, 1000]", &format!("[200, {samples}]"));
        folder.write("study.toml", &text);
        Self { folder, whole: OnceCell::new() }
    }

    /// The report of one run.
    pub(crate) fn whole(&self) -> &Files {
        self.whole.get_or_init(|| {
            let (code, reported) = run(&self.folder, &["study.toml", "--quiet", "--out", "whole"], "");
            assert_eq!(code, Some(0), "{reported}");
            files(&self.folder.path("whole"))
        })
    }

    /// `switchback launch`, submitted or kept for later.
    pub(crate) fn launch<C: Cluster>(&self, cluster: &C, more: &[&str]) -> Launched {
        let (out, work) = (self.folder.path("out"), self.folder.path("out-parts"));
        fs::create_dir_all(&work).expect("a folder");
        let mut launched = Launched { out, work, script: None };
        let tasks = PARTS.to_string();
        let arguments = ["launch", "study.toml", C::OPTION, "--tasks", &tasks, "--out", "out"];
        let mut command = Command::new(env!("CARGO_BIN_EXE_switchback"));
        command.current_dir(self.folder.path(".")).args(arguments).args(more);
        if more.contains(&"--submit") {
            launched.start(&mut command, cluster);
        } else {
            let printed = command.output().expect("it runs");
            assert!(printed.status.success(), "{}", String::from_utf8_lossy(&printed.stderr));
            fs::write(launched.work.join("launch.sh"), printed.stdout).expect("it can be written");
        }
        launched
    }
}

/// A study that is running.
pub(crate) struct Launched {
    pub(crate) out: PathBuf,
    pub(crate) work: PathBuf,
    script: Option<Child>,
}

impl Launched {
    pub(crate) fn start_script<C: Cluster>(&mut self, cluster: &C) {
        let mut command = Command::new("bash");
        command.arg(self.work.join("launch.sh"));
        self.start(&mut command, cluster);
    }

    pub(crate) fn edit_script(&self, change: impl Fn(&str) -> String) {
        let place = self.work.join("launch.sh");
        let text = change(&fs::read_to_string(&place).expect("a script"));
        fs::write(place, text).expect("it can be written");
    }

    fn start<C: Cluster>(&mut self, command: &mut Command, cluster: &C) {
        let reported =
            File::options().create(true).append(true).open(self.work.join("reported")).expect("a new file");
        command.envs(cluster.environment()).stdin(Stdio::null());
        command.stderr(reported.try_clone().expect("a second handle")).stdout(reported);
        self.script = Some(command.spawn().expect("it starts"));
    }

    pub(crate) fn wait_for_the_script(&mut self) {
        if let Some(mut script) = self.script.take() {
            script.wait().expect("it ends");
        }
    }

    /// Waits until something has come about.
    #[track_caller]
    pub(crate) fn wait(&mut self, what: &str, mut has_come: impl FnMut(&Self) -> bool) {
        let begun = Instant::now();
        while !has_come(self) {
            let patience = Duration::from_secs(1800);
            assert!(begun.elapsed() < patience, "not seen: {what}\n{}", self.reported());
            sleep(Duration::from_millis(50));
        }
    }

    pub(crate) fn part(&self, number: usize) -> PathBuf {
        self.work.join(format!("round-1/part-{number}"))
    }

    /// Parts of the first round that are finished.
    pub(crate) fn finished(&self) -> Vec<usize> {
        (1..=PARTS).filter(|&number| self.part(number).join("part.json").exists()).collect()
    }

    pub(crate) fn has_report(&self) -> bool {
        self.out.join("results.json").exists()
    }

    /// How often a part of the first round was begun.
    pub(crate) fn turns(&self, number: usize) -> usize {
        let begun = format!("part {number} of {PARTS} on ");
        self.logs().iter().map(|text| text.lines().filter(|line| line.starts_with(&begun)).count()).sum()
    }

    /// What script, parts and merge have said.
    pub(crate) fn reported(&self) -> String {
        let reported = fs::read_to_string(self.work.join("reported")).unwrap_or_default();
        [vec![reported], self.logs()].concat().concat()
    }

    fn logs(&self) -> Vec<String> {
        let logs = fs::read_dir(self.work.join("round-1/log")).into_iter().flatten().flatten();
        logs.map(|log| fs::read_to_string(log.path()).unwrap_or_default()).collect()
    }
}

impl Drop for Launched {
    fn drop(&mut self) {
        if let Some(script) = &mut self.script {
            let _ = script.kill();
            let _ = script.wait();
        }
    }
}
