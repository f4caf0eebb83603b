//! Slow after-effects of the operator's output.

use super::super::law::{Law, Parameter, Unit};
use super::super::motion::Motion;
use super::super::scale::Scale;
use super::super::signals::Span;

const SHARE: (f64, f64) = (-0.95, 20.0);

/// `u + c·(lag(u, τ) − u)`: a share that arrives late.
#[derive(Debug)]
pub(super) struct Late;

/// `u + c·branch·ln(1 + n/τ)`, `n` the samples since the reversal.
#[derive(Debug)]
pub(super) struct SinceReversal;

/// `u − c·branch·(1 − e^(−n/τ))`, `n` the samples of rest.
#[derive(Debug)]
pub(super) struct AtRest;

const LATE: [Parameter; 2] = [
    Parameter::new("creep_share", Unit::One, SHARE),
    Parameter::new("creep_time", Unit::Samples, (0.5, 1e7)),
];
const ADDED: [Parameter; 2] = [
    Parameter::new("creep_force", Unit::Output, (f64::NEG_INFINITY, f64::INFINITY)),
    Parameter::new("creep_time", Unit::Samples, (0.1, 1e7)),
];

fn times(scale: &Scale) -> [f64; 3] {
    let longest = (scale.samples as f64 / 5.0).max(20.0);
    let shortest = (3.0 * scale.settling).clamp(3.0, longest / 4.0);
    [shortest, (shortest * longest).sqrt(), longest]
}

impl Law for Late {
    fn effect(&self) -> &'static str {
        "creep"
    }

    fn name(&self) -> &'static str {
        "late"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &LATE
    }

    fn starts(&self, scale: &Scale) -> Vec<Vec<f64>> {
        times(scale).map(|tau| vec![0.1, tau]).into()
    }

    /// Slower than the records last it is a change of level, and faster than the linear part a change of that.
    fn is_sound(&self, values: &[f64], scale: &Scale) -> bool {
        (3.0 * scale.settling..3.0 * scale.samples as f64).contains(&values[1])
    }

    fn input(&self, values: &[f64], _: &Motion, _: Span, u: &mut [f64]) {
        let Some(mut slow) = u.first().copied() else { return };
        let kept = (-1.0 / values[1]).exp();
        for u in u {
            slow = kept * slow + (1.0 - kept) * *u;
            *u += values[0] * (slow - *u);
        }
    }
}

impl Law for SinceReversal {
    fn effect(&self) -> &'static str {
        "creep"
    }

    fn name(&self) -> &'static str {
        "since_reversal"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &ADDED
    }

    fn starts(&self, scale: &Scale) -> Vec<Vec<f64>> {
        vec![vec![0.05 * scale.output, 3.0]]
    }

    /// Within a sample of the reversal it is friction, and slower than the records last a force by the time.
    fn is_sound(&self, values: &[f64], scale: &Scale) -> bool {
        (1.0..3.0 * scale.samples as f64).contains(&values[1])
    }

    fn input(&self, values: &[f64], motion: &Motion, _: Span, u: &mut [f64]) {
        for (t, u) in u.iter_mut().enumerate() {
            *u += values[0] * motion.direction[t] * (motion.since[t] / values[1]).ln_1p();
        }
    }
}

impl Law for AtRest {
    fn effect(&self) -> &'static str {
        "creep"
    }

    fn name(&self) -> &'static str {
        "at_rest"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &ADDED
    }

    fn starts(&self, scale: &Scale) -> Vec<Vec<f64>> {
        [5.0, 40.0].map(|tau| vec![0.1 * scale.output, tau]).into()
    }

    fn is_sound(&self, values: &[f64], scale: &Scale) -> bool {
        values[1] < 3.0 * scale.samples as f64
    }

    fn input(&self, values: &[f64], motion: &Motion, _: Span, u: &mut [f64]) {
        for (t, u) in u.iter_mut().enumerate() {
            *u -= values[0] * motion.direction[t] * (1.0 - (-motion.rest[t] / values[1]).exp());
        }
    }
}
