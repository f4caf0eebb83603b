//! `provenance.json`: where, when and by what results were made. It lies beside them and is never compared: the results hold only what
//! determines the numbers.

use crate::output::stamped;
use crate::platform::platform;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::Path;
use std::time::Instant;

/// Its name.
pub const PROVENANCE_FILE: &str = "provenance.json";

/// The sources that a program was built from.
#[derive(Debug, Clone, Copy)]
pub struct Build {
    /// The commit, `-dirty` if files had been changed; empty where that is not known.
    pub commit: &'static str,
    /// SHA-256 of the sources that run replicates.
    pub study_sources: &'static str,
    /// SHA-256 of Cargo.lock: the versions of all libraries.
    pub lock: &'static str,
}

/// A run that is under way.
#[derive(Debug)]
pub struct Provenance {
    begun: Instant,
    record: Record,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
struct Record {
    /// Switchback's version.
    version: String,
    /// The commit that the program was built from, `-dirty` if files had been changed; nothing where that is not known.
    commit: String,
    /// SHA-256 of the sources that run replicates.
    sources: String,
    /// SHA-256 of Cargo.lock: the versions of all libraries.
    lock: String,
    /// Processor, system, and a hash of what the mathematical library gives.
    platform: String,
    /// The words of the command line.
    command_line: Vec<String>,
    /// Worker threads.
    threads: usize,
    /// The parts that were put together.
    shards: Vec<String>,
    /// When the command began, UTC.
    begun: String,
    /// How long it took.
    seconds: f64,
}

impl Provenance {
    /// A command that begins, on so many threads.
    pub fn begin(build: Build, threads: usize) -> Self {
        let record = Record {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            commit: build.commit.to_owned(),
            sources: build.study_sources.to_owned(),
            lock: build.lock.to_owned(),
            platform: platform(),
            command_line: std::env::args().collect(),
            threads,
            shards: Vec::new(),
            begun: jiff::Timestamp::now().to_string(),
            seconds: 0.0,
        };
        Self { begun: Instant::now(), record }
    }

    /// … and ends, after it has put these parts together.
    #[must_use]
    pub fn end(mut self, shards: Vec<String>) -> Self {
        self.record.shards = shards;
        self.record.seconds = (self.begun.elapsed().as_secs_f64() * 1e3).round() / 1e3;
        self
    }

    /// How this program and machine differ from those that made the results of a folder, or of a file in it: a line each.
    pub fn differences(&self, results: &Path, version: &str) -> Vec<String> {
        let folder = if results.is_dir() { results } else { results.parent().unwrap_or(Path::new("")) };
        let text = fs::read_to_string(folder.join(PROVENANCE_FILE)).ok();
        let made = text.and_then(|text| serde_json::from_str::<Record>(&text).ok());
        let here = &self.record;
        let line =
            |what, then: &str, now: &str| (then != now).then(|| format!("{what}: {then} then, {now} now"));
        let made = made.as_ref();
        let lines = [
            line("version", version, &here.version),
            made.and_then(|made| line("platform", &made.platform, &here.platform)),
            made.and_then(|made| line("commit", &made.commit, &here.commit)),
            made.and_then(|made| line("sources", short(&made.sources), short(&here.sources))),
            made.and_then(|made| line("libraries (Cargo.lock)", short(&made.lock), short(&here.lock))),
        ];
        lines.into_iter().flatten().collect()
    }

    /// The file.
    pub fn text(&self) -> String {
        stamped("switchback/provenance/1", &self.record)
    }
}

/// The beginning of a hash: enough to tell two apart.
fn short(hash: &str) -> &str {
    hash.get(..12).unwrap_or(hash)
}
