//! Two causes of one size are both named.

mod common;

use common::verdict_on_made;
use serde_json::Value;

/// The effects named on a made rig with two of them, sorted.
fn named([one, other]: [&str; 2], size: &str, [seed, order]: [&str; 2]) -> Vec<String> {
    let effects = ["--effect", one, "--effect", other];
    let what = ["--size", size, "--seed", seed, "--order", order];
    let verdict = verdict_on_made(&[&effects[..], &what].concat());
    let effects = verdict["effects"].as_array().expect("a list");
    let mut names: Vec<String> = effects.iter().filter_map(Value::as_str).map(String::from).collect();
    names.sort_unstable();
    names
}

#[test]
fn friction_that_rules_the_dynamics_is_found_behind_a_sensor_that_clips() {
    let effects = ["rate_dependence", "sensor_saturation"];
    assert_eq!(named(effects, "1", ["6926790249606298369", "2"]), effects);
}

#[test]
fn a_delay_is_found_behind_a_sensor_that_drifts_far() {
    let effects = ["input_delay", "sensor_drift"];
    assert_eq!(named(effects, "4", ["5012396695533306556", "2"]), effects);
}

#[test]
fn heavy_tails_are_found_beside_a_sensor_that_bends() {
    let effects = ["outliers", "sensor_nonlinearity"];
    assert_eq!(named(effects, "2", ["1", "2"]), effects);
}

#[test]
fn a_step_of_the_borders_is_found_behind_coarse_rounding() {
    let effects = ["border_resolution", "sensor_quantisation"];
    assert_eq!(named(effects, "2", ["1", "2"]), effects);
}

#[test]
fn a_gain_that_drifts_a_little_is_found_behind_a_sensor_that_clips() {
    let effects = ["gain_drift", "sensor_saturation"];
    assert_eq!(named(effects, "1", ["6952109671641562290", "1"]), effects);
}
