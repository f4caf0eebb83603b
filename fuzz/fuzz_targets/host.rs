//! What the process of an FMU says: outputs of the records asked for, or a reason, whatever it writes.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| switchback_fuzz::host::run(bytes));
