//! A sensor whose characteristic is curved.

use super::super::law::{Law, Parameter, Unit};
use super::super::motion::Motion;
use super::super::scale::Scale;
use super::super::signals::Span;

/// `y + c·size·e²`, `e = (y − centre)/size`.
#[derive(Debug)]
pub(super) struct Square;

/// `y + c·size·e³`.
#[derive(Debug)]
pub(super) struct Cube;

const PARAMETERS: [Parameter; 3] = [
    Parameter::new("curvature_of_sensor", Unit::One, (-0.9, 0.9)),
    Parameter::constant("centre", Unit::Output),
    Parameter::constant("size", Unit::Output),
];

fn starts(scale: &Scale) -> Vec<Vec<f64>> {
    let (low, high) = scale.ends;
    vec![vec![0.05, 0.5 * (low + high), 0.5 * (high - low).max(f64::MIN_POSITIVE)]]
}

fn bend(values: &[f64], y: &mut [f64], power: i32) {
    for y in y {
        *y += values[0] * values[2] * ((*y - values[1]) / values[2]).powi(power);
    }
}

impl Law for Square {
    fn effect(&self) -> &'static str {
        "sensor_nonlinearity"
    }

    fn name(&self) -> &'static str {
        "square"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn starts(&self, scale: &Scale) -> Vec<Vec<f64>> {
        starts(scale)
    }

    fn output(&self, values: &[f64], _: &Motion, _: Span, y: &mut [f64]) {
        bend(values, y, 2);
    }
}

impl Law for Cube {
    fn effect(&self) -> &'static str {
        "sensor_nonlinearity"
    }

    fn name(&self) -> &'static str {
        "cube"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn starts(&self, scale: &Scale) -> Vec<Vec<f64>> {
        starts(scale)
    }

    fn output(&self, values: &[f64], _: &Motion, _: Span, y: &mut [f64]) {
        bend(values, y, 3);
    }
}
