//! The experiments of a random campaign, on the interval [−1, 1].

use rand::{Rng, RngExt};
use switchback_estimator::rig::Role;

use super::Planned;

/// A campaign's inputs.
pub(super) struct Drive {
    pub(super) records: Vec<Planned>,
}

impl Drive {
    /// Steps, both pulse experiments and a free sweep to fit; a free drive and a repeat held out.
    pub(super) fn draw(rng: &mut impl Rng, order: usize) -> Self {
        let points: usize = rng.random_range(4..9);
        let periods = 100;
        let spacing = order.max(2);
        let step = |from: f64, n: usize| {
            let mut v = vec![-from];
            v.resize(n, from);
            v
        };
        let plan = |name, role, held_out, v| Planned { name, role, held_out, v };
        let records = vec![
            plan("step_high", Role::StepHigh, false, step(1.0, 1200)),
            plan("descendant", Role::Descendant, false, pulses(1.0, points, spacing, periods)),
            plan("step_low", Role::StepLow, false, step(-1.0, 1200)),
            plan("ascendant", Role::Ascendant, false, pulses(-1.0, points, spacing, periods)),
            plan("sweep", Role::Free, false, wander(rng, 4000)),
            plan("drive", Role::Free, true, wander(rng, 3000)),
            plan("descendant_again", Role::Descendant, true, pulses(1.0, points, spacing, 30)),
        ];
        Self { records }
    }
}

/// Visits of one sample each from the satellite, levels evenly spaced.
fn pulses(satellite: f64, points: usize, spacing: usize, periods: usize) -> Vec<f64> {
    let period = spacing * (points + 3);
    let mut v = vec![-satellite];
    for _ in 0..periods {
        let mut one = vec![satellite; period];
        for j in 0..points {
            let at = if j == 0 { 2 } else { 3 + j } * spacing;
            one[at.min(period - 1)] = -satellite + 2.0 * satellite * j as f64 / points as f64;
        }
        v.extend(one);
    }
    v
}

/// Straight moves of random length between random levels, some with a rest.
fn wander(rng: &mut impl Rng, n: usize) -> Vec<f64> {
    let mut v: Vec<f64> = vec![0.0];
    while v.len() < n {
        let from = v[v.len() - 1];
        let to: f64 = if rng.random::<f64>() < 0.6 {
            rng.random_range(-1.0..1.0)
        } else {
            (from + rng.random_range(-0.4..0.4)).clamp(-1.0, 1.0)
        };
        let samples = rng.random_range(3..40);
        v.extend((1..=samples).map(|k| from + (to - from) * k as f64 / samples as f64));
        if rng.random::<f64>() < 0.3 {
            let rest = rng.random_range(2..8);
            v.extend(std::iter::repeat_n(to, rest));
        }
    }
    v.truncate(n);
    v
}
