//! Files of measurements that end in .mat.
#![no_main]

use libfuzzer_sys::fuzz_target;
use switchback_fuzz::{Scratch, one_file};

thread_local!(static FOLDER: Scratch = Scratch::new());

fuzz_target!(|bytes: &[u8]| FOLDER.with(|folder| one_file(folder, "fuzz.mat", bytes)));
