//! Diagnoses of short random rigs: a verdict with finite figures, or a refusal.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| switchback_fuzz::gap::run(bytes));
