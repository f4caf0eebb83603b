//! `provenance.json`: where, when and by what results were made. It lies beside them and is never compared: the results hold only what
//! determines the numbers.

use crate::output::{stamped, stamped_schema};
use crate::platform::platform;
use schemars::{JsonSchema, Schema};
use serde::Serialize;
use std::time::Instant;

/// Its name.
pub const PROVENANCE_FILE: &str = "provenance.json";

/// Name and version of the layout.
const SCHEMA: &str = "switchback/provenance/1";

/// The JSON Schema of the file.
pub fn schema() -> Schema {
    stamped_schema::<Record>(SCHEMA)
}

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

/// A run that is running.
#[derive(Debug)]
pub struct Provenance {
    begun: Instant,
    record: Record,
}

/// Where, when and by what results were made: `provenance.json`. It is never compared.
#[derive(Debug, Clone, Serialize, JsonSchema)]
struct Record {
    /// Switchback's version.
    version: String,
    /// The commit that the program was built from, `-dirty` if files had been changed; empty where that is not known.
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
    #[schemars(regex(pattern = "^[0-9]{4}-[0-9]{2}-[0-9]{2}T"))]
    begun: String,
    /// How long it took.
    #[schemars(range(min = 0))]
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

    /// The file.
    pub fn text(&self) -> String {
        stamped(SCHEMA, &self.record)
    }
}
