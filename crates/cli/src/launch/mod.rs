//! Scripts by which a scheduler that is there already runs a study in parts: `switchback SCENARIO --shard K/N` for each, and
//! `switchback merge` behind them.
//!
//! A script begins with what differs from one study to the next, as variables of the shell; the rest is the same text for every study of an
//! engine, most of it for all engines.

mod time_limit;

pub(crate) use time_limit::TimeLimit;

use std::fmt::Write;
use std::path::PathBuf;
use switchback_io::output::{in_shell, path_in_shell};

/// What runs the parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Engine {
    /// Slurm: job arrays, and a merge job behind them.
    Slurm,
    /// HyperQueue: a task array, which the script waits for.
    HyperQueue,
}

impl Engine {
    /// The program that takes the work.
    fn submits_by(self) -> &'static str {
        match self {
            Self::Slurm => "sbatch",
            Self::HyperQueue => "hq",
        }
    }

    /// The part of the script that is its own.
    fn text(self) -> &'static str {
        match self {
            Self::Slurm => include_str!("slurm.sh"),
            Self::HyperQueue => include_str!("hq.sh"),
        }
    }
}

/// Seconds before its time limit at which Slurm signals a part; it may do so a minute earlier.
const NOTICE: u64 = 60;

/// What a scheduler is to run.
#[derive(Debug, Clone)]
pub(crate) struct Launch {
    /// What runs it.
    pub(crate) engine: Engine,
    /// The command that makes the script again, for its first line.
    pub(crate) command: String,
    /// This program.
    pub(crate) program: PathBuf,
    /// The scenario's file, absolute.
    pub(crate) scenario: PathBuf,
    /// The scenario's name, that of the jobs.
    pub(crate) name: String,
    /// In how many parts.
    pub(crate) parts: usize,
    /// Threads of each.
    pub(crate) threads: usize,
    /// How long a part runs before it makes room for another.
    pub(crate) time: Option<TimeLimit>,
    /// Options of each job, as the scheduler takes them, besides threads and time.
    pub(crate) options: Vec<String>,
    /// Where the parts go, absolute.
    pub(crate) work: PathBuf,
    /// Where the report goes, absolute.
    pub(crate) out: PathBuf,
}

impl Launch {
    /// A script of bash that gives the work to the engine.
    pub(crate) fn script(&self) -> String {
        self.header() + include_str!("common.sh") + self.engine.text()
    }

    fn header(&self) -> String {
        let mut text = format!(
            "#!/bin/bash\n# {} in {} parts. Written by `{}`; change it as you like, and run it where `{}` is.\n\n",
            in_shell(&self.name),
            self.parts,
            self.command,
            self.engine.submits_by()
        );
        let path = |path: &PathBuf| path_in_shell(path);
        let options: Vec<String> = self.options().iter().map(|option| in_shell(option)).collect();
        let of_all = [
            ("switchback", path(&self.program)),
            ("scenario", path(&self.scenario)),
            ("name", in_shell(&self.name)),
            ("parts", self.parts.to_string()),
            ("work", path(&self.work)),
            ("out", path(&self.out)),
            ("options", format!("({})", options.join(" "))),
        ];
        for (name, value) in of_all.into_iter().chain(self.of_the_engine()) {
            let _ = writeln!(text, "{name}={value}");
        }
        text.push('\n');
        text
    }

    /// Options of each job, as the engine calls them. Both give a job one processor where nothing is said.
    fn options(&self) -> Vec<String> {
        let threads = match (self.engine, self.threads) {
            (_, 1) => None,
            (Engine::Slurm, threads) => Some(format!("--cpus-per-task={threads}")),
            (Engine::HyperQueue, threads) => Some(format!("--cpus={threads}")),
        };
        let time = self.time.iter().filter(|_| self.engine == Engine::Slurm);
        let time = time.map(|time| format!("--time={time}"));
        threads.into_iter().chain(time).chain(self.options.iter().cloned()).collect()
    }

    /// Variables that only the engine's own part of the script reads.
    fn of_the_engine(&self) -> Vec<(&'static str, String)> {
        match self.engine {
            Engine::Slurm => vec![("notice", NOTICE.to_string())],
            Engine::HyperQueue => {
                let seconds = self.time.as_ref().map_or_else(String::new, |time| time.seconds().to_string());
                vec![("threads", self.threads.to_string()), ("seconds", seconds)]
            }
        }
    }
}
