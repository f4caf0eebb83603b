//! A part of a study, as `merge` reads it.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| switchback_fuzz::merge::run(bytes));
