//! A force that grows with the speed.

use super::super::law::{Law, Parameter, Unit};
use super::super::motion::Motion;
use super::super::scale::Scale;
use super::super::signals::{Operator, Span};

/// `u + c·dv/dt`: a viscous damper beside the operator.
#[derive(Debug)]
pub(super) struct Viscous;

/// `u + c·branch·√(r/r₀)`, `r` the speed, kept at rest.
#[derive(Debug)]
pub(super) struct Root;

const VISCOUS: [Parameter; 1] =
    [Parameter::new("damping", Unit::OutputPerSpeed, (f64::NEG_INFINITY, f64::INFINITY))];
const ROOT: [Parameter; 2] = [
    Parameter::new("rate_coefficient", Unit::Output, (f64::NEG_INFINITY, f64::INFINITY)),
    Parameter::constant("reference_speed", Unit::Speed),
];

impl Law for Viscous {
    fn effect(&self) -> &'static str {
        "rate_dependence"
    }

    fn name(&self) -> &'static str {
        "viscous"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &VISCOUS
    }

    fn starts(&self, scale: &Scale) -> Vec<Vec<f64>> {
        vec![vec![0.1 * scale.output / scale.speed]]
    }

    fn operator(&self, values: &[f64], motion: &Motion, _: Span, operator: &mut Operator) {
        for (added, velocity) in operator.added.iter_mut().zip(&motion.velocity) {
            *added += values[0] * velocity;
        }
    }
}

impl Law for Root {
    fn effect(&self) -> &'static str {
        "rate_dependence"
    }

    fn name(&self) -> &'static str {
        "root"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &ROOT
    }

    fn starts(&self, scale: &Scale) -> Vec<Vec<f64>> {
        vec![vec![0.1 * scale.output, scale.speed]]
    }

    fn operator(&self, values: &[f64], motion: &Motion, _: Span, operator: &mut Operator) {
        for (t, added) in operator.added.iter_mut().enumerate() {
            *added += values[0] * motion.direction[t] * (motion.speed[t] / values[1]).sqrt();
        }
    }
}
