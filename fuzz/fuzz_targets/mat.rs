//! Files of measurements that end in .mat.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| switchback_fuzz::mat::run(bytes));
