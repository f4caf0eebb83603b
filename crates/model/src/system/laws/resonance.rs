//! A lightly damped mode.

use super::super::law::{Law, Parameter, Unit};
use super::super::motion::Motion;
use super::super::scale::Scale;
use super::super::signals::Span;

/// `u + c·G(q⁻¹)u`, `G` a band-pass of unit gain at its frequency: a mode in parallel.
#[derive(Debug)]
pub(super) struct Parallel;

const PARAMETERS: [Parameter; 3] = [
    Parameter::new("mode_gain", Unit::One, (-20.0, 20.0)),
    Parameter::new("mode_frequency", Unit::Frequency, (1e-4, 3.0)),
    Parameter::new("mode_damping", Unit::One, (1e-3, 0.9)),
];

impl Law for Parallel {
    fn effect(&self) -> &'static str {
        "resonance"
    }

    fn name(&self) -> &'static str {
        "parallel"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn starts(&self, _: &Scale) -> Vec<Vec<f64>> {
        [0.08, 0.16, 0.32, 0.6, 1.1, 2.0].map(|frequency| vec![0.3, frequency, 0.05]).into()
    }

    fn input(&self, values: &[f64], _: &Motion, _: Span, u: &mut [f64]) {
        let (frequency, damping) = (values[1], values[2]);
        let radius = (-frequency * damping).exp();
        let [a1, a2] =
            [-2.0 * radius * (frequency * (1.0 - damping * damping).sqrt()).cos(), radius * radius];
        let b = 0.5 * (1.0 - a2);
        let (mut x, mut y) = ([u.first().copied().unwrap_or(0.0); 2], [0.0; 2]);
        for u in u {
            let now = b * (*u - x[1]) - a1 * y[0] - a2 * y[1];
            (x, y) = ([*u, x[0]], [now, y[0]]);
            *u += values[0] * now;
        }
    }
}
