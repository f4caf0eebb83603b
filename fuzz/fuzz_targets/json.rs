//! What the program wrote and reads again: results of studies, and models, which must run once they were read.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| switchback_fuzz::json::run(bytes));
