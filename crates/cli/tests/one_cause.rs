//! One cause is named alone: whatever looks like a second one beside it is no cause of its own.

use crate::common::{diagnosis_of_made, verdict_on_made};
use serde_json::{Value, json};

/// The verdict on a made rig with one effect.
fn verdict(effect: &str, law: &str, size: &str, (seed, order): (&str, &str)) -> Value {
    let what = ["--effect", effect, "--law", law, "--size", size, "--seed", seed, "--order", order];
    verdict_on_made(&what)
}

#[test]
fn where_a_play_stood_before_the_record_is_no_second_cause() {
    let verdict = verdict("backlash", "0", "4", ("218432656797407362", "2"));
    assert_eq!(verdict["effects"], json!(["backlash"]), "{verdict:#}");
}

#[test]
fn readings_that_repeat_because_they_are_rounded_leave_no_outliers() {
    let verdict = verdict("sensor_quantisation", "0", "2", ("13802676115951568624", "2"));
    assert_eq!(verdict["effects"], json!(["sensor_quantisation"]), "{verdict:#}");
}

#[test]
fn a_soft_knee_is_no_second_cause() {
    let verdict = verdict("sensor_saturation", "2", "2", ("13097605359539705777", "3"));
    assert_eq!(verdict["effects"], json!(["sensor_saturation"]), "{verdict:#}");
}

#[test]
fn what_an_inexact_law_leaves_is_a_correction() {
    let verdict = verdict("extra_pole", "2", "4", ("6731017774290076540", "3"));
    assert_eq!(verdict["effects"], json!(["extra_pole"]), "{verdict:#}");
    assert!(verdict["corrected_by"].is_string(), "{verdict:#}");
}

#[test]
fn a_slow_pole_is_no_second_cause_beside_a_gain_that_drifts() {
    let verdict = verdict("gain_drift", "0", "4", ("6618236462401797109", "3"));
    assert_eq!(verdict["effects"], json!(["gain_drift"]), "{verdict:#}");
}

#[test]
fn the_unknown_zero_of_the_output_is_no_second_cause_beside_a_gain_that_wanders() {
    let verdict = verdict("gain_drift", "2", "4", ("17263246882115084920", "2"));
    assert_eq!(verdict["effects"], json!(["gain_drift"]), "{verdict:#}");
}

#[test]
fn a_twin_that_gains_more_alone_is_a_rival_of_one_that_needs_a_correction() {
    let verdict = verdict("input_delay", "1", "4", ("9551534221114429084", "1"));
    assert_eq!(verdict["status"], "class", "{verdict:#}");
    assert_eq!(verdict["class"], json!(["input_delay", "extra_pole"]), "{verdict:#}");
}

#[test]
fn a_zero_that_drifts_on_between_the_records_is_distinguished_from_noise_that_lasts() {
    let ramp = ["--effect", "sensor_drift", "--size", "4", "--seed", "6539456920451778020", "--order", "2"];
    let diagnosis = diagnosis_of_made(&ramp);
    assert_eq!(diagnosis["verdict"]["effects"], json!(["sensor_drift"]), "{:#}", diagnosis["verdict"]);
    let closure = diagnosis["gap"]["closure"]["estimate"].as_f64();
    assert!(closure.is_some_and(|closure| closure > 0.9), "{:#}", diagnosis["gap"]);
}

#[test]
fn a_zero_that_differs_from_record_to_record_is_no_drift() {
    let verdict = verdict("record_offset", "0", "2", ("5120933187", "3"));
    assert_eq!(verdict["effects"], json!(["record_offset"]), "{verdict:#}");
}

#[test]
fn a_gain_and_a_loop_that_step_are_no_drift_and_no_wear() {
    for (law, seed) in [("0", "5120933188"), ("1", "5120933189")] {
        let verdict = verdict("step_change", law, "2", (seed, "3"));
        assert_eq!(verdict["effects"], json!(["step_change"]), "{verdict:#}");
    }
}
