//! Scenario files of all three kinds: a text is a scenario, or refused in words.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| switchback_fuzz::scenario::run(bytes));
