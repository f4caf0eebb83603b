//! Logs of robots that end in .mcap.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| switchback_fuzz::mcap::run(bytes));
