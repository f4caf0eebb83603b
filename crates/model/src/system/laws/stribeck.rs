//! Friction that falls as the speed rises from zero.

use super::super::law::{Law, Parameter, Unit};
use super::super::motion::Motion;
use super::super::scale::Scale;
use super::super::signals::{Operator, Span};

/// `u + c·branch·exp(−r/r_s)`, `r` the speed, kept at rest.
#[derive(Debug)]
pub(super) struct Falling;

const PARAMETERS: [Parameter; 2] = [
    Parameter::new("stribeck_force", Unit::Output, (f64::NEG_INFINITY, f64::INFINITY)),
    Parameter::new("stribeck_speed", Unit::Speed, (0.0, f64::INFINITY)),
];

impl Law for Falling {
    fn effect(&self) -> &'static str {
        "stribeck"
    }

    fn name(&self) -> &'static str {
        "falling"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn starts(&self, scale: &Scale) -> Vec<Vec<f64>> {
        [0.2, 0.6, 1.5].map(|share| vec![0.1 * scale.output, share * scale.speed]).into()
    }

    /// Far above the speeds of the records the force is constant, and far below it is never met.
    fn is_sound(&self, values: &[f64], scale: &Scale) -> bool {
        (0.1..2.0).contains(&(values[1] / scale.speed))
    }

    fn operator(&self, values: &[f64], motion: &Motion, _: Span, operator: &mut Operator) {
        if values[1] > 0.0 {
            for (t, added) in operator.added.iter_mut().enumerate() {
                *added += values[0] * motion.direction[t] * (-motion.speed[t] / values[1]).exp();
            }
        }
    }
}
