//! A zero that differs from record to record.

use super::super::law::{Law, Parameter, Unit};
use super::super::motion::Motion;
use super::super::scale::Scale;
use super::super::signals::Span;

/// `y + c` in one record.
#[derive(Debug)]
pub(super) struct OfOneRecord;

const PARAMETERS: [Parameter; 2] = [
    Parameter::new("record_offset", Unit::Output, (f64::NEG_INFINITY, f64::INFINITY)),
    Parameter::constant("record", Unit::One),
];

impl Law for OfOneRecord {
    fn effect(&self) -> &'static str {
        "record_offset"
    }

    fn name(&self) -> &'static str {
        "one_record"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn starts(&self, scale: &Scale) -> Vec<Vec<f64>> {
        // One record has no other to differ from.
        (0..scale.records).filter(|_| scale.records > 1).map(|k| vec![0.1 * scale.output, k as f64]).collect()
    }

    fn output(&self, values: &[f64], _: &Motion, span: Span, y: &mut [f64]) {
        if span.record as f64 == values[1] {
            y.iter_mut().for_each(|y| *y += values[0]);
        }
    }
}
