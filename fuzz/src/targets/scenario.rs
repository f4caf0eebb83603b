//! Scenario files of all three kinds: a text is a scenario, or refused in words.

use super::{Scratch, reported, text_of};
use switchback_lab::{blind, field};
use switchback_study::scenario::Scenario;

thread_local!(static FOLDER: Scratch = Scratch::new());

/// Runs it on an input.
pub fn run(bytes: &[u8]) {
    let Some(text) = text_of(bytes) else { return };
    if let Err(refusal) = Scenario::parse("fuzz.toml", text) {
        reported(&refusal);
    }
    let path = FOLDER.with(|folder| folder.write("fuzz.toml", bytes));
    if blind::is_blind(&path)
        && let Err(refusal) = blind::read(&path)
    {
        reported(&refusal);
    }
    if field::is_field(&path)
        && let Err(refusal) = field::read(&path)
    {
        reported(&refusal);
    }
}
