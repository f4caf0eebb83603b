//! Where one binary holds all tests of a crate, it names every file of them: one that it forgot would never run.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// The modules that a folder of tests can have: files, and folders with a `mod.rs`.
fn files(folder: &Path) -> BTreeSet<String> {
    fs::read_dir(folder)
        .expect("a folder")
        .map(|entry| entry.expect("a readable entry").path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "rs") || path.join("mod.rs").exists())
        .map(|path| path.file_stem().expect("a name").to_string_lossy().into_owned())
        .filter(|name| name != "all")
        .collect()
}

/// The modules that a binary names.
fn named(binary: &str) -> BTreeSet<String> {
    let modules = binary.lines().filter_map(|line| line.strip_prefix("mod ")?.strip_suffix(';'));
    modules.map(str::to_owned).collect()
}

#[test]
fn every_file_of_tests_is_run() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut found = 0;
    for entry in fs::read_dir(crates).expect("crates/") {
        let tests = entry.expect("a readable entry").path().join("tests");
        if let Ok(binary) = fs::read_to_string(tests.join("all.rs")) {
            assert_eq!(named(&binary), files(&tests), "{} against its files", tests.join("all.rs").display());
            found += 1;
        }
    }
    assert_ne!(found, 0, "this crate has such a binary");
}
