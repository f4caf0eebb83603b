//! Logs of robots that end in .mcap.

use super::{Scratch, one_file};

thread_local!(static FOLDER: Scratch = Scratch::new());

/// Runs it on an input.
pub fn run(bytes: &[u8]) {
    FOLDER.with(|folder| one_file(folder, "fuzz.mcap", bytes));
}
