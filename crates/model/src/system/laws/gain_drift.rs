//! A gain that changes with time.

use super::super::law::{Law, Parameter, Unit};
use super::super::motion::Motion;
use super::super::scale::Scale;
use super::super::signals::Span;

/// `u·(1 + c·s)`, `s` the share of the dataset that is over.
#[derive(Debug)]
pub(super) struct Straight;

const PARAMETERS: [Parameter; 1] = [Parameter::new("gain_change", Unit::One, (-0.99, 20.0))];

impl Law for Straight {
    fn effect(&self) -> &'static str {
        "gain_drift"
    }

    fn name(&self) -> &'static str {
        "straight"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn starts(&self, _: &Scale) -> Vec<Vec<f64>> {
        vec![vec![0.1]]
    }

    fn input(&self, values: &[f64], _: &Motion, span: Span, u: &mut [f64]) {
        for (t, u) in u.iter_mut().enumerate() {
            *u *= 1.0 + values[0] * span.clock(t);
        }
    }
}
