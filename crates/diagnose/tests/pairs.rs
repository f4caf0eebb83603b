//! Two effects at once, each put into the bench's rig by hand.

use crate::bench::{input, output, record, rig};
use switchback_diagnose::{Effect, Model, Settings, Status, diagnose};
use switchback_model::rig::{Rig, Usage};

/// The bench's rig, its output changed by a sensor that sees `(time, output)`.
fn sensed(input_seen: impl Fn(&[f64]) -> Vec<f64>, sensor: impl Fn(f64, f64) -> f64) -> Rig {
    let made = |name: &str, usage: Usage, samples: usize, phase: f64| {
        let v = input(samples, phase);
        let y = output(&input_seen(&v)).iter().enumerate().map(|(t, y)| sensor(t as f64, *y)).collect();
        record(name, usage, v, y)
    };
    rig(Some(1), vec![made("sweep", Usage::Fit, 4000, 0.0), made("drive", Usage::Holdout, 2000, 1.0)])
}

fn late(by: usize) -> impl Fn(&[f64]) -> Vec<f64> {
    move |v| (0..v.len()).map(|t| v[t.saturating_sub(by)]).collect()
}

fn named(rig: &Rig) -> Vec<Effect> {
    let diagnosis = diagnose(rig, Model::Identify, &Settings::default()).expect("a diagnosis");
    assert_eq!(diagnosis.verdict.status, Status::Named, "{:?}", diagnosis.verdict);
    let mut effects = diagnosis.verdict.effects;
    effects.sort_unstable();
    effects
}

fn sorted(mut effects: [Effect; 2]) -> [Effect; 2] {
    effects.sort_unstable();
    effects
}

#[test]
fn a_late_input_and_a_hum_are_found_together() {
    let rig = sensed(late(2), |t, y| y + 0.05 * (0.9 * t).sin());
    assert_eq!(named(&rig), sorted([Effect::InputDelay, Effect::PeriodicDisturbance]));
}

#[test]
fn coarse_rounding_does_not_hide_a_late_input() {
    let rig = sensed(late(2), |_, y| (y / 0.1).round() * 0.1);
    assert_eq!(named(&rig), sorted([Effect::InputDelay, Effect::SensorQuantisation]));
}

#[test]
fn rounding_alone_stays_alone() {
    let rig = sensed(late(0), |_, y| (y / 0.1).round() * 0.1);
    assert_eq!(named(&rig), [Effect::SensorQuantisation]);
}
