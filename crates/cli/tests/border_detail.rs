//! What counts as a detail of the borders, and what is their own.

use crate::common::{verdict_on_changed, verdict_on_made};
use serde_json::json;

/// `rig.toml` with nothing but its free records.
fn only_free_records(rig: &str) -> String {
    let mut parts = rig.split("[[record]]");
    let head = parts.next().unwrap_or_default().to_owned();
    parts
        .filter(|record| record.contains("role = \"free\""))
        .fold(head, |text, record| text + "[[record]]" + record)
}

#[test]
fn without_designed_experiments_a_jump_is_the_borders_own() {
    let verdict = verdict_on_changed(&["--seed", "53006", "--order", "3"], only_free_records);
    assert_eq!(verdict["status"], "none", "{verdict:#}");
}

#[test]
fn without_designed_experiments_a_ripple_is_a_detail() {
    let what = ["--effect", "border_resolution", "--law", "2", "--size", "2", "--seed", "52032"];
    let verdict = verdict_on_changed(&what, only_free_records);
    assert_eq!(verdict["effects"], json!(["border_resolution"]), "{verdict:#}");
}

#[test]
fn the_kink_of_a_loop_that_closes_is_no_detail() {
    let verdict = verdict_on_made(&["--seed", "16343969258348231233", "--order", "2"]);
    assert_eq!(verdict["status"], "none", "{verdict:#}");
}
