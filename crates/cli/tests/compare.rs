//! `switchback compare`: what it refuses, and how. Comparing good tables is tested where the tables are made.

use assert_cmd::Command;
use std::fs;
use tempfile::tempdir;

#[track_caller]
fn refused(content: Option<&str>, reported: &str) {
    let folder = tempdir().expect("a temporary folder");
    let baseline = folder.path().join("results.json");
    if let Some(content) = content {
        fs::write(&baseline, content).expect("it can be written");
    }
    let out = folder.path().join("out");
    let output = Command::cargo_bin("switchback")
        .expect("the binary")
        .arg("compare")
        .args([&baseline, &baseline])
        .arg("--out")
        .arg(&out)
        .output()
        .expect("it runs");
    let stderr = String::from_utf8(output.stderr).expect("UTF-8");
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    assert!(
        stderr.contains("results.json") && stderr.contains(reported) && stderr.contains("help: "),
        "{stderr}"
    );
    assert!(!out.exists(), "nothing is written");
}

#[test]
fn a_missing_file_is_refused() {
    refused(None, "no such file");
}

#[test]
fn a_file_that_is_no_results_table_is_refused() {
    refused(Some("t,v,y\n0,1,2\n"), "is not a results file");
    refused(Some("{\"verdict\": \"none\"}"), "is not a results file");
}

#[test]
fn another_layout_is_refused() {
    refused(Some("{\"schema\": 7, \"cells\": []}"), "results layout 7");
}
