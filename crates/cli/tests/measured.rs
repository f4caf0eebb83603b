//! `switchback gap` on measured rigs, which are others' work: `cargo test -- --ignored measured` where they are beside the workspace.

use crate::common::Folder;
use serde_json::Value;
use std::path::Path;

/// The diagnosis of a measured rig.
fn diagnosed(name: &str) -> Value {
    let rig = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/rigs").join(name).join("rig.toml");
    let folder = Folder::with_good_rig();
    let file = rig.display().to_string();
    let output = folder.switchback(&["gap", &file, "--json"]).output().expect("it runs");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let page: Value = serde_json::from_slice(&output.stdout).expect("one JSON object on stdout");
    println!(
        "{name}: {:#}
{:#}",
        page["verdict"], page["gap"]
    );
    page
}

/// The effect named, or the first of its class.
fn leading(page: &Value) -> &str {
    let verdict = &page["verdict"];
    verdict["effects"][0].as_str().or(verdict["class"][0].as_str()).unwrap_or_default()
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

#[test]
#[ignore = "reads shared/rigs beside the workspace"]
fn a_loop_that_closes_without_a_jump_has_no_other_cause_for_certain() {
    let page = diagnosed("piezo-stage");
    // It lacks a gradual transition; the posterior has learnt this stage with other faults carried into it, and lists these.
    assert_eq!(page["verdict"]["status"], "shortlist", "{:#}", page["verdict"]);
    assert!(number(&page["gap"]["closure"]["ci90"][0]) > 0.4);
    assert!(number(&page["gap"]["per_record"][0]["fit_after"]) > 94.0);
}

#[test]
#[ignore = "reads shared/rigs beside the workspace"]
fn the_damper_lacks_an_effect_of_speed() {
    let page = diagnosed("mr-damper");
    assert!(["rate_dependence", "stribeck"].contains(&leading(&page)), "{:#}", page["verdict"]);
    assert!(number(&page["gap"]["closure"]["ci90"][0]) > 0.5);
    // Newton: the force swings by some thousand, and noise is a small part of what the best model misses.
    assert!(number(&page["gap"]["noise_floor"]) < 150.0);
}

#[test]
#[ignore = "reads shared/rigs beside the workspace"]
fn the_seal_is_nearly_what_the_model_says() {
    let page = diagnosed("pneumatic-seal");
    let gap = &page["gap"];
    assert!(number(&gap["per_record"][0]["fit_before"]) > 93.0);
    assert!(number(&gap["before"]["estimate"]) < 0.005);
    // A little is left, of no candidate's making, and nothing is claimed that the held-out record does not show.
    assert_eq!(page["verdict"]["status"], "unexplained");
    assert!(number(&gap["after"]["estimate"]) <= number(&gap["before"]["estimate"]));
}

/// The upper tank runs over.
#[test]
#[ignore = "reads shared/rigs beside the workspace"]
fn a_shortlist_holds_the_documented_cause() {
    let page = diagnosed("field/cascaded-tanks");
    assert_eq!(page["verdict"]["status"], "shortlist", "{:#}", page["verdict"]);
    assert_eq!(leading(&page), "sensor_saturation");
    assert_eq!(page["posterior"]["causes"][0]["cause"], "sensor_saturation");
}
