//! A loop that narrows or widens as the machine works.

use super::super::law::{Law, Parameter, Unit};
use super::super::motion::Motion;
use super::super::scale::Scale;
use super::super::signals::{Operator, Span};

/// `width·(1 + c·s)`, `s` the share of the dataset that is over.
#[derive(Debug)]
pub(super) struct Wear;

const PARAMETERS: [Parameter; 1] = [Parameter::new("wear", Unit::One, (-0.99, 20.0))];

impl Law for Wear {
    fn effect(&self) -> &'static str {
        "border_wear"
    }

    fn name(&self) -> &'static str {
        "even"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn starts(&self, _: &Scale) -> Vec<Vec<f64>> {
        vec![vec![0.2]]
    }

    fn operator(&self, values: &[f64], _: &Motion, span: Span, operator: &mut Operator) {
        for (t, width) in operator.width.iter_mut().enumerate() {
            *width *= 1.0 + values[0] * span.clock(t);
        }
    }
}
