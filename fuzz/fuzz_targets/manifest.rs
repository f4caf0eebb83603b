//! Rig files beside a good file of measurements: a rig, or refused in words; a rig that was read is written and read back as the same.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| switchback_fuzz::manifest::run(bytes));
