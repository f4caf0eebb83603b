//! Two causes of one size are both named.

use crate::common::diagnosis_of_made;
use serde_json::Value;

/// The diagnosis of a made rig with two effects.
fn diagnosis([one, other]: [&str; 2], size: &str, [seed, order]: [&str; 2]) -> Value {
    let effects = ["--effect", one, "--effect", other];
    let what = ["--size", size, "--seed", seed, "--order", order];
    diagnosis_of_made(&[&effects[..], &what].concat())
}

/// The effects named on it, sorted.
fn named(put_in: [&str; 2], size: &str, seed_and_order: [&str; 2]) -> Vec<String> {
    let verdict = &diagnosis(put_in, size, seed_and_order)["verdict"];
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

#[test]
fn a_slow_lag_is_found_beside_friction_that_rules_the_dynamics() {
    let effects = ["extra_pole", "rate_dependence"];
    assert_eq!(named(effects, "4", ["3133952703731551655", "3"]), effects);
}

#[test]
fn friction_behind_coarse_rounding_is_reported_as_it_is_beside_it() {
    let page = diagnosis(["sensor_quantisation", "rate_dependence"], "4", ["16227372047960906123", "1"]);
    assert_eq!(page["verdict"]["effects"].as_array().map(Vec::len), Some(2), "{:#}", page["verdict"]);
    let together = &page["together"];
    let of = |effect: &str| {
        let members = together["effects"].as_array().expect("both effects");
        let number = members.iter().position(|member| member == effect).expect("one of both");
        together["parameters"][number][0].clone()
    };
    // The friction is viscous; alone it takes some of what the rounding leaves.
    let power = of("rate_dependence");
    let (low, high) = (power["ci90"][0].as_f64(), power["ci90"][1].as_f64());
    assert!(power["name"] == "power" && low < Some(1.0) && high > Some(1.0), "{power:#}");
    let step = of("sensor_quantisation");
    assert!(step["name"] == "step" && step["value"].as_f64() > Some(0.0), "{step:#}");
}
