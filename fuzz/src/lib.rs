//! What the targets share: a file to be read, in memory where the system offers that.

mod one_file;

pub use one_file::one_file;

use std::path::{Path, PathBuf};

/// A folder of this process, in memory under Linux.
pub struct Scratch(PathBuf);

impl Scratch {
    /// Makes it.
    pub fn new() -> Self {
        let memory = Path::new("/dev/shm");
        let root = if memory.is_dir() { memory.to_owned() } else { std::env::temp_dir() };
        let folder = root.join(format!("switchback-fuzz-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a writable temporary folder");
        Self(folder)
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

/// Tells a refusal as a terminal and a file would have it, so that messages are fuzzed too.
pub fn told(refusal: &dyn miette::Diagnostic) {
    let words = switchback::failure::plain(refusal);
    assert!(words.starts_with("error: ") && words.len() < 1 << 16, "a refusal of {} bytes", words.len());
}
