//! Tables of data frames that end in .parquet.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| switchback_fuzz::parquet::run(bytes));
