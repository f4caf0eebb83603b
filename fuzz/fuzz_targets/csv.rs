//! Files of measurements that end in .csv.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| switchback_fuzz::csv::run(bytes));
