//! Scripts by which a scheduler that is there already runs a study in parts: `switchback SCENARIO --shard K/N` for each, and
//! `switchback merge` behind them.
//!
//! A script begins with what differs from one study to the next, as variables of the shell; the rest is the same text for every study.

use crate::rig::in_shell;
use std::fmt::Write;
use std::path::PathBuf;

/// What a scheduler is to run.
#[derive(Debug, Clone)]
pub struct Launch {
    /// The command that makes the script again, for its first line.
    pub command: String,
    /// This program.
    pub program: PathBuf,
    /// The scenario's file, absolute.
    pub scenario: PathBuf,
    /// The scenario's name, that of the jobs.
    pub name: String,
    /// In how many parts.
    pub parts: usize,
    /// Where the parts go, absolute.
    pub work: PathBuf,
    /// Where the report goes, absolute.
    pub out: PathBuf,
    /// Options of each job, as the scheduler takes them.
    pub options: Vec<String>,
}

impl Launch {
    /// A script of bash that submits job arrays to Slurm.
    pub fn slurm(&self) -> String {
        self.header("sbatch") + include_str!("slurm.sh")
    }

    fn header(&self, submits: &str) -> String {
        let mut text = format!(
            "#!/bin/bash\n# {} in {} parts. Written by `{}`; change it as you like, and run it where `{submits}` is.\n\n",
            self.name, self.parts, self.command
        );
        let path = |path: &PathBuf| in_shell(&path.display().to_string());
        let options: Vec<String> = self.options.iter().map(|option| in_shell(option)).collect();
        for (name, value) in [
            ("switchback", path(&self.program)),
            ("scenario", path(&self.scenario)),
            ("name", in_shell(&self.name)),
            ("parts", self.parts.to_string()),
            ("work", path(&self.work)),
            ("out", path(&self.out)),
            ("options", format!("({})", options.join(" "))),
        ] {
            let _ = writeln!(text, "{name}={value}");
        }
        text.push('\n');
        text
    }
}
