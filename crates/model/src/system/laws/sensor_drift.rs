//! A zero of the sensor that moves.

use super::super::law::{Law, Parameter, Unit};
use super::super::motion::Motion;
use super::super::scale::Scale;
use super::super::signals::Span;

/// `y + c·s`, `s` the share of the dataset that is over.
#[derive(Debug)]
pub(super) struct Straight;

const PARAMETERS: [Parameter; 1] =
    [Parameter::new("drift", Unit::Output, (f64::NEG_INFINITY, f64::INFINITY))];

impl Law for Straight {
    fn effect(&self) -> &'static str {
        "sensor_drift"
    }

    fn name(&self) -> &'static str {
        "straight"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn starts(&self, scale: &Scale) -> Vec<Vec<f64>> {
        vec![vec![0.1 * scale.output]]
    }

    fn output(&self, values: &[f64], _: &Motion, span: Span, y: &mut [f64]) {
        for (t, y) in y.iter_mut().enumerate() {
            *y += values[0] * span.clock(t);
        }
    }
}
