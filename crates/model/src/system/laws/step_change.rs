//! A change at one instant.

use super::super::law::{Law, Parameter, Unit};
use super::super::motion::Motion;
use super::super::scale::Scale;
use super::super::signals::{Operator, Span};

/// `width·(1 + c)` from an instant on.
#[derive(Debug)]
pub(super) struct OfWidth;

/// `u·(1 + c)` from an instant on.
#[derive(Debug)]
pub(super) struct OfGain;

const PARAMETERS: [Parameter; 2] =
    [Parameter::new("change", Unit::One, (-0.99, 20.0)), Parameter::constant("instant", Unit::One)];

fn starts() -> Vec<Vec<f64>> {
    (1..16).map(|k| vec![0.1, f64::from(k) / 16.0]).collect()
}

impl Law for OfWidth {
    fn effect(&self) -> &'static str {
        "step_change"
    }

    fn name(&self) -> &'static str {
        "width"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn starts(&self, _: &Scale) -> Vec<Vec<f64>> {
        starts()
    }

    fn operator(&self, values: &[f64], _: &Motion, span: Span, operator: &mut Operator) {
        for (_, width) in operator.width.iter_mut().enumerate().filter(|(t, _)| span.clock(*t) >= values[1]) {
            *width *= 1.0 + values[0];
        }
    }
}

impl Law for OfGain {
    fn effect(&self) -> &'static str {
        "step_change"
    }

    fn name(&self) -> &'static str {
        "gain"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn starts(&self, _: &Scale) -> Vec<Vec<f64>> {
        starts()
    }

    fn input(&self, values: &[f64], _: &Motion, span: Span, u: &mut [f64]) {
        for (_, u) in u.iter_mut().enumerate().filter(|(t, _)| span.clock(*t) >= values[1]) {
            *u *= 1.0 + values[0];
        }
    }
}
