//! What a diagnosis reports a cause is what was put in.

use crate::common::diagnosis_of_made;
use serde_json::Value;

/// A parameter of the candidate for an effect.
fn parameter(page: &Value, effect: &str, name: &str) -> Value {
    let find = |list: &Value, key: &str, what: &str| {
        list.as_array().and_then(|all| all.iter().find(|one| one[key] == what)).cloned()
    };
    let candidate = find(&page["candidates"], "effect", effect).expect("a candidate");
    find(&candidate["parameters"], "name", name).unwrap_or_else(|| panic!("no {name} in {candidate:#}"))
}

fn interval(parameter: &Value) -> std::ops::RangeInclusive<f64> {
    let end = |k: usize| parameter["ci90"][k].as_f64().expect("an end of the interval");
    end(0)..=end(1)
}

#[test]
fn the_interval_of_a_play_holds_what_no_sample_decides() {
    let what = ["--effect", "backlash", "--size", "2", "--seed", "514"];
    let page = diagnosis_of_made(&what);
    let play = interval(&parameter(&page, "backlash", "play"));
    // The maker moves a play of full width 0.02 intervals of 20.
    assert!(play.contains(&0.4), "{play:?}");
    assert!(play.end() - play.start() < 0.01, "{play:?}");
}

#[test]
fn a_lag_is_reported_by_its_time_constant() {
    let what = ["--effect", "extra_pole", "--size", "2", "--seed", "20261301"];
    let page = diagnosis_of_made(&what);
    let pole = parameter(&page, "extra_pole", "pole")["value"].as_f64().expect("a number");
    let tau = interval(&parameter(&page, "extra_pole", "time_constant"));
    let sample_time = 0.001;
    assert!(tau.contains(&(-sample_time / pole.ln())), "{tau:?} {pole}");
}

#[test]
fn limits_and_shares_are_read_off() {
    let page = diagnosis_of_made(&["--effect", "sensor_saturation", "--size", "2", "--seed", "20261301"]);
    let [low, high] = ["lower_limit", "upper_limit"]
        .map(|name| parameter(&page, "sensor_saturation", name)["value"].as_f64().expect("a number"));
    assert!(low < high);
    let page = diagnosis_of_made(&["--effect", "outliers", "--size", "2", "--seed", "20261301"]);
    let share = parameter(&page, "outliers", "share")["value"].as_f64().expect("a number");
    assert!(share > 0.001 && share < 0.2, "{share}");
}
