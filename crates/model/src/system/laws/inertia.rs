//! A force by the acceleration.

use super::super::law::{Law, Parameter, Unit};
use super::super::motion::Motion;
use super::super::scale::Scale;
use super::super::signals::{Operator, Span};

/// `u + m·d²v/dt²`: a mass, or the armature of a motor, moved by the input.
#[derive(Debug)]
pub(super) struct Mass;

const PARAMETERS: [Parameter; 1] =
    [Parameter::new("inertia", Unit::OutputPerAcceleration, (f64::NEG_INFINITY, f64::INFINITY))];

impl Law for Mass {
    fn effect(&self) -> &'static str {
        "inertia"
    }

    fn name(&self) -> &'static str {
        "mass"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn starts(&self, scale: &Scale) -> Vec<Vec<f64>> {
        vec![vec![0.1 * scale.output / scale.acceleration]]
    }

    fn operator(&self, values: &[f64], motion: &Motion, _: Span, operator: &mut Operator) {
        for (added, acceleration) in operator.added.iter_mut().zip(&motion.acceleration) {
            *added += values[0] * acceleration;
        }
    }
}
