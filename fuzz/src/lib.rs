//! What is fuzzed: a function from bytes that panics where something is wrong, one for each target.
//!
//! `fuzz_targets` hands them to libFuzzer; `crates/cli/tests/fuzz.rs`, which takes this file in, to an ordinary test.

#[path = "targets/csv.rs"]
pub mod csv;
#[path = "targets/gap.rs"]
pub mod gap;
#[path = "targets/host.rs"]
pub mod host;
#[path = "targets/json.rs"]
pub mod json;
#[path = "targets/manifest.rs"]
pub mod manifest;
#[path = "targets/mat.rs"]
pub mod mat;
#[path = "targets/mcap.rs"]
pub mod mcap;
#[path = "targets/mdf.rs"]
pub mod mdf;
#[path = "targets/merge.rs"]
pub mod merge;
mod one_file;
#[path = "targets/page.rs"]
pub mod page;
#[path = "targets/parquet.rs"]
pub mod parquet;
#[path = "targets/scenario.rs"]
pub mod scenario;

use one_file::one_file;
use std::path::{Path, PathBuf};

/// A folder of this process, in memory under Linux.
pub struct Scratch(PathBuf);

impl Scratch {
    /// Makes it.
    pub fn new() -> Self {
        let memory = Path::new("/dev/shm");
        let root = if memory.is_dir() { memory.to_owned() } else { std::env::temp_dir() };
        let folder =
            root.join(format!("switchback-fuzz-{}-{:?}", std::process::id(), std::thread::current().id()));
        std::fs::create_dir_all(&folder).expect("a writable temporary folder");
        Self(folder)
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// Writes a file into it.
    pub fn write(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.0.join(name);
        std::fs::write(&path, bytes).expect("a writable temporary folder");
        path
    }
}

impl Default for Scratch {
    fn default() -> Self {
        Self::new()
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        // What is left is a few files in memory.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Shows a refusal as a terminal and a file would have it, so that messages are fuzzed too.
pub fn reported(refusal: &dyn miette::Diagnostic) {
    let words = switchback_io::output::plain(refusal);
    assert!(words.starts_with("error: ") && words.len() < 1 << 16, "a refusal of {} bytes", words.len());
}

/// The text that bytes are, if they are one.
fn text_of(bytes: &[u8]) -> Option<&str> {
    std::str::from_utf8(bytes).ok()
}
