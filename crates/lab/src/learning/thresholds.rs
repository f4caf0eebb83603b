//! Thresholds of what is reported, fitted by losses.

use switchback_diagnose::posterior::{Losses, Outcome, Posterior, Thresholds, decide};

/// What the classes of a table are.
pub fn outcomes(classes: &[String]) -> Vec<Outcome> {
    let one = |class: &String| match class.as_str() {
        Posterior::NOTHING => Outcome::Nothing,
        Posterior::NONE_OF_THESE => Outcome::NoneOfThese,
        _ => Outcome::Effect,
    };
    classes.iter().map(one).collect()
}

/// Steps of a threshold between a half and one.
const STEPS: usize = 100;

/// The thresholds of least mean loss on rows that were held out, `named` and `class` on a grid of half a per cent; the larger of equals.
pub fn fit_thresholds(
    p: &[Vec<f64>],
    labels: &[usize],
    outcomes: &[Outcome],
    losses: &Losses,
) -> (Thresholds, f64) {
    let mut best = (Thresholds::default(), f64::INFINITY);
    let steps = || (0..=STEPS).rev().map(|k| 0.5 + 0.5 * k as f64 / STEPS as f64);
    let mean = |thresholds: &Thresholds| {
        let loss = |(p, label): (&Vec<f64>, &usize)| {
            losses.of(&decide(p, outcomes, thresholds, false), *label, outcomes)
        };
        p.iter().zip(labels).map(loss).sum::<f64>() / p.len().max(1) as f64
    };
    for named in steps() {
        for class in steps() {
            let thresholds = Thresholds { named, class, ..Thresholds::default() };
            let loss = mean(&thresholds);
            if loss < best.1 {
                best = (thresholds, loss);
            }
        }
    }
    best
}
