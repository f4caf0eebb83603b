//! Scenario files of all three kinds: a text is a scenario, or refused in words.
#![no_main]

use libfuzzer_sys::fuzz_target;
use switchback::scenario::Scenario;
use switchback::{blind, field};
use switchback_fuzz::{Scratch, told};

thread_local!(static FOLDER: Scratch = Scratch::new());

fuzz_target!(|text: &str| {
    if let Err(refusal) = Scenario::parse("fuzz.toml", text) {
        told(&refusal);
    }
    let path = FOLDER.with(|folder| folder.write("fuzz.toml", text.as_bytes()));
    if blind::is_blind(&path)
        && let Err(refusal) = blind::read(&path)
    {
        told(&refusal);
    }
    if field::is_field(&path)
        && let Err(refusal) = field::read(&path)
    {
        told(&refusal);
    }
});
