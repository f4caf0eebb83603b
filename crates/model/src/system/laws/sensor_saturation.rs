//! A sensor that clips.

use super::super::law::{Law, Parameter, Unit};
use super::super::motion::Motion;
use super::super::scale::Scale;
use super::super::signals::Span;

/// `min(y, top − c)`.
#[derive(Debug)]
pub(super) struct Above;

/// `max(y, bottom + c)`.
#[derive(Debug)]
pub(super) struct Below;

const ABOVE: [Parameter; 2] = [
    Parameter::new("clipped_above", Unit::Output, (0.0, f64::INFINITY)),
    Parameter::constant("top", Unit::Output),
];
const BELOW: [Parameter; 2] = [
    Parameter::new("clipped_below", Unit::Output, (0.0, f64::INFINITY)),
    Parameter::constant("bottom", Unit::Output),
];
const SHARES: [f64; 3] = [0.05, 0.12, 0.25];

impl Law for Above {
    fn effect(&self) -> &'static str {
        "sensor_saturation"
    }

    fn name(&self) -> &'static str {
        "above"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &ABOVE
    }

    fn starts(&self, scale: &Scale) -> Vec<Vec<f64>> {
        let (low, high) = scale.ends;
        SHARES.map(|share| vec![share * (high - low), high]).into()
    }

    fn output(&self, values: &[f64], _: &Motion, _: Span, y: &mut [f64]) {
        if values[0] > 0.0 {
            y.iter_mut().for_each(|y| *y = y.min(values[1] - values[0]));
        }
    }
}

impl Law for Below {
    fn effect(&self) -> &'static str {
        "sensor_saturation"
    }

    fn name(&self) -> &'static str {
        "below"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &BELOW
    }

    fn starts(&self, scale: &Scale) -> Vec<Vec<f64>> {
        let (low, high) = scale.ends;
        SHARES.map(|share| vec![share * (high - low), low]).into()
    }

    fn output(&self, values: &[f64], _: &Motion, _: Span, y: &mut [f64]) {
        if values[0] > 0.0 {
            y.iter_mut().for_each(|y| *y = y.max(values[1] + values[0]));
        }
    }
}
