//! Effects that rule what the dynamics are identified from: the nominal model is that of another system.

use crate::bench::{input, record, rig, white};
use switchback_diagnose::{Effect, Model, Settings, Status, diagnose};
use switchback_model::rig::{Rig, Usage};

/// A second-order plant, `u` and the equation error given.
fn plant(u: &[f64], errors: &[f64]) -> Vec<f64> {
    let mut y: Vec<f64> = Vec::with_capacity(u.len());
    for t in 0..u.len() {
        let past = |x: &[f64], lag: usize| if t >= lag { x[t - lag] } else { 0.0 };
        y.push(1.1 * past(&y, 1) - 0.4 * past(&y, 2) + 0.2 * past(u, 1) + 0.1 * past(u, 2) + errors[t]);
    }
    y
}

/// Two curved borders; `width` is that of the loop at a sample.
fn operator(v: &[f64], width: impl Fn(usize) -> f64) -> Vec<f64> {
    let mut u = vec![-1.0];
    for t in 1..v.len() {
        let border = v[t] + 0.3 * v[t] * v[t] + 0.5 * width(t) * (v[t] - v[t - 1]).signum();
        u.push(if v[t] == v[t - 1] { u[t - 1] } else { border });
    }
    u
}

/// A rig whose records are made by `output` from the input, white errors and the time at which the record begins.
fn made(output: impl Fn(&[f64], Vec<f64>, usize) -> Vec<f64>) -> Rig {
    let one = |name: &str, usage: Usage, samples: usize, phase: f64, clock: usize| {
        let v = input(samples, phase);
        let mut white = white(clock as u64 + 1);
        let errors = (0..samples).map(|_| 0.005 * white()).collect();
        let y = output(&v, errors, clock);
        record(name, usage, v, y)
    };
    let records = vec![
        one("sweep", Usage::Fit, 4000, 0.0, 0),
        one("again", Usage::Fit, 3000, 0.4, 4000),
        one("drive", Usage::Holdout, 2000, 1.0, 7000),
    ];
    rig(Some(2), records)
}

fn named(rig: &Rig) -> Vec<Effect> {
    let diagnosis = diagnose(rig, Model::Identify, &Settings::default()).expect("a diagnosis");
    assert_eq!(diagnosis.verdict.status, Status::Named, "{:?}", diagnosis.verdict);
    diagnosis.verdict.effects
}

#[test]
fn a_slow_lag_that_began_elsewhere_is_found() {
    let rig = made(|v, errors, _| {
        let mut state = 2.0;
        let lagged: Vec<f64> = operator(v, |_| 1.0)
            .iter()
            .map(|u| {
                state = 0.97 * state + 0.03 * u;
                state
            })
            .collect();
        plant(&lagged, &errors)
    });
    assert_eq!(named(&rig), [Effect::ExtraPole]);
}

#[test]
fn a_line_far_above_everything_else_is_found() {
    let hum = |t: usize| 0.5 * (0.5741 * t as f64).sin();
    let rig = made(|v, errors, clock| {
        let errors: Vec<f64> = errors.iter().enumerate().map(|(t, e)| e + hum(clock + t)).collect();
        plant(&operator(v, |_| 1.0), &errors)
    });
    assert_eq!(named(&rig), [Effect::PeriodicDisturbance]);
}

#[test]
fn a_loop_that_closes_is_found() {
    let rig = made(|v, errors, clock| plant(&operator(v, |t| 1.0 - (clock + t) as f64 / 9000.0), &errors));
    assert_eq!(named(&rig), [Effect::BorderWear]);
}

#[test]
fn errors_that_last_are_found() {
    let rig = made(|v, errors, _| {
        let mut state = 0.0;
        let lasting: Vec<f64> = errors
            .iter()
            .map(|e| {
                state = 0.99 * state + e;
                state
            })
            .collect();
        plant(&operator(v, |_| 1.0), &lasting)
    });
    assert_eq!(named(&rig), [Effect::ColouredNoise]);
}

/// A running mean has zeros beside the unit circle, which no autoregression of moderate length has.
#[test]
fn errors_that_are_a_running_mean_are_found() {
    let rig = made(|v, errors, _| {
        let mean = |t: usize| errors[t] + 0.97 * errors[t.saturating_sub(5)..t].iter().sum::<f64>();
        let averaged: Vec<f64> = (0..errors.len()).map(mean).collect();
        plant(&operator(v, |_| 1.0), &averaged)
    });
    assert_eq!(named(&rig), [Effect::ColouredNoise]);
}
