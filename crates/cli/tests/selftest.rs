//! The self-test as a user runs it.

use assert_cmd::Command;
use serde_json::Value;

#[test]
fn every_check_passes_on_a_seed_that_nobody_chose() {
    let mut command = Command::cargo_bin("switchback").expect("the binary is built");
    let output =
        command.args(["selftest", "--json", "--quiet", "--seed", "20240229"]).output().expect("it runs");
    let page: Value = serde_json::from_slice(&output.stdout).expect("one JSON object");
    assert_eq!(output.status.code(), Some(0), "{page:#}");
    assert!(output.stderr.is_empty());
    let checks = page["checks"].as_array().expect("checks");
    assert_eq!((page["ok"].as_bool(), checks.len()), (Some(true), 6));
    assert!(checks.iter().all(|check| check["figures"].as_array().is_some_and(|figures| figures.len() > 1)));
}
