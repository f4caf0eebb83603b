//! Logs of cars that end in .mf4.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| switchback_fuzz::mdf::run(bytes));
