//! The folder of a report, drawn as a page: files one after the other, each behind a line `=== NAME`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| switchback_fuzz::page::run(bytes));
