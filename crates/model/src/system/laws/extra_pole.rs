//! A lag more than the linear part has.

use super::super::law::{Law, Parameter, Unit};
use super::super::motion::Motion;
use super::super::scale::Scale;
use super::super::signals::Span;

/// A first-order lag of unit gain before the linear part.
#[derive(Debug)]
pub(super) struct Lag;

const PARAMETERS: [Parameter; 1] = [Parameter::new("lag", Unit::Samples, (0.0, 1e7))];

impl Law for Lag {
    fn effect(&self) -> &'static str {
        "extra_pole"
    }

    fn name(&self) -> &'static str {
        "lag"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn starts(&self, scale: &Scale) -> Vec<Vec<f64>> {
        [0.4, 1.5, 5.0, 3.0 * scale.settling].map(|tau| vec![tau]).into()
    }

    fn input(&self, values: &[f64], _: &Motion, _: Span, u: &mut [f64]) {
        let Some(mut x) = u.first().copied() else { return };
        let kept = if values[0] > 0.0 { (-1.0 / values[0]).exp() } else { 0.0 };
        for u in u {
            x = kept * x + (1.0 - kept) * *u;
            *u = x;
        }
    }
}
