//! Scenario files of all three kinds: a text is a scenario, or refused in words.

use super::{Scratch, reported, text_of};
use switchback_lab::examination::{design_of, read};
use switchback_study::scenario::Scenario;

thread_local!(static FOLDER: Scratch = Scratch::new());

/// Runs it on an input.
pub fn run(bytes: &[u8]) {
    let Some(text) = text_of(bytes) else { return };
    if let Err(refusal) = Scenario::parse("fuzz.toml", text) {
        reported(&refusal);
    }
    let path = FOLDER.with(|folder| folder.write("fuzz.toml", bytes));
    if design_of(&path).is_some()
        && let Err(refusal) = read(&path)
    {
        reported(&refusal);
    }
}
