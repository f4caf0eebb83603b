//! The sensor clips.
//!
//! ```text
//! y = min(max(x, low), high): many samples equal the extreme value exactly
//! x = y + w·(e^z − 1 − z),  z = (y − k)/w beyond a knee k: the range ends softly
//! ```
//!
//! Parameters: the limits, read off the ties; or knee `k` and width `w`, at the upper end, the lower, or both. Samples at a limit, and those whose regressors reach one, only say that `x`
//! lies beyond: they are left out of the sum of squares. Stage: sensor. Confused with: sensor nonlinearity.

use super::{Card, Follows, Reading, Scene, Variant, parameter};
use crate::effect::{Effect, Stage};
use crate::fitted_parameter::FittedParameter;
use crate::model::augmented::Saturation;
use crate::model::sensor::Knee;

pub(super) const CARD: Card = Card {
    confounded_effects: &[Effect::SensorNonlinearity],
    misreads: true,
    follows: Some(Follows::Steps),
    reported_first: limits_and_knees,
    ..Card::of(Stage::Sensor, variants)
};

/// Ties at an extreme that chance does not make, in samples.
const TIES: usize = 6;

/// Deviance that a tie at an extreme is worth: chance leaves none, to a few digits.
const TIE: f64 = -20.0;

fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    let hard = hard(scene);
    // A smooth curve would turn the ties into an endless density: where there are ties, only the hard limit is asked.
    if hard.is_empty() { soft(scene) } else { hard }
}

/// Knees at either end of the readings or at both.
fn soft(scene: &Scene<'_>) -> Vec<Variant> {
    let readings = || scene.dataset.fit().flat_map(|t| &t.y);
    let low = readings().fold(f64::INFINITY, |l, &y| l.min(y));
    let high = readings().fold(f64::NEG_INFINITY, |h, &y| h.max(y));
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    [&[1.0][..], &[-1.0], &[1.0, -1.0]]
        .into_iter()
        .map(|ends| {
            let starts = [0.5, 0.75]
                .iter()
                .map(|&at| {
                    vec![
                        parameter("knee", "share of the half range", at, (0.1, 0.98), 0.005),
                        parameter("width", "share of the half range", 1.0, (0.05, 20.0), 0.005),
                    ]
                })
                .collect();
            Variant::conditional(starts, move |p, augmented| {
                augmented.curve.knees.extend(ends.iter().map(|&sign| Knee {
                    level: middle + sign * p[0] * half,
                    width: p[1] * half,
                    sign,
                }));
            })
        })
        .collect()
}

fn hard(scene: &Scene<'_>) -> Vec<Variant> {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for y in scene.dataset.fit().flat_map(|t| &t.y) {
        low = low.min(*y);
        high = high.max(*y);
    }
    let ties = |limit: f64| scene.dataset.fit().flat_map(|t| &t.y).filter(|y| **y == limit).count();
    // On a coarse quantisation grid every value has ties: the extreme one must have more than its inner neighbour.
    let inner = |limit: f64| {
        let next = scene
            .dataset
            .fit()
            .flat_map(|t| &t.y)
            .filter(|y| **y != limit)
            .min_by(|a, b| (*a - limit).abs().total_cmp(&(*b - limit).abs()));
        next.map_or(0, |n| ties(*n))
    };
    let (low_ties, high_ties) = (ties(low), ties(high));
    let clipped = |limit: f64, ties: usize| ties >= TIES && ties > 3 * inner(limit);
    let (at_low, at_high) = (clipped(low, low_ties), clipped(high, high_ties));
    if !at_low && !at_high {
        return Vec::new();
    }
    let limits = Saturation {
        low: if at_low { low } else { f64::NEG_INFINITY },
        high: if at_high { high } else { f64::INFINITY },
        order: scene.fit.linear.a.len(),
    };
    let tied = if at_low { low_ties } else { 0 } + if at_high { high_ties } else { 0 };
    let mut variant = Variant::new(vec![Vec::new()], move |_, augmented| augmented.saturation = Some(limits));
    let mut rest: Vec<f64> =
        scene.dataset.fit().flat_map(|t| t.y.iter().copied()).filter(|y| *y != low && *y != high).collect();
    let count = rest.len();
    rest.sort_by(f64::total_cmp);
    rest.dedup();
    // Rounding ties every plateau, at the extremes too.
    if 3 * rest.len() > 2 * count {
        variant.size_penalty = TIE * tied as f64;
    }
    vec![variant]
}

fn limits_and_knees(reading: &Reading<'_>) -> Vec<FittedParameter> {
    let augmented = &reading.fit.augmented;
    let limits = augmented.saturation.iter().flat_map(|s| [("lower_limit", s.low), ("upper_limit", s.high)]);
    let knee = |sign: f64| if sign > 0.0 { "upper_knee" } else { "lower_knee" };
    let knees = augmented.curve.knees.iter().map(|k| (knee(k.sign), k.level));
    limits.chain(knees).filter(|(_, y)| y.is_finite()).map(|(name, y)| reading.level(name, y)).collect()
}
