//! A friction that grows with the speed until it slips, in place of one that switches: the constraint of MuJoCo, the friction of Modelica or Simscape.

use super::super::law::{Law, Parameter, Unit};
use super::super::motion::Motion;
use super::super::scale::Scale;
use super::super::signals::{Operator, Span};
use std::f64::consts::FRAC_PI_2;

/// `z = clamp(w/w₀, −1, 1)` with `w` the speed that decides the direction.
#[derive(Debug)]
pub(super) struct Clamped;

/// `z = tanh(w/w₀)`.
#[derive(Debug)]
pub(super) struct Hyperbolic;

/// `z = 2/π·arctan(w/w₀)`.
#[derive(Debug)]
pub(super) struct Arctangent;

const PARAMETERS: [Parameter; 1] = [Parameter::new("slip_speed", Unit::Speed, (0.0, f64::INFINITY))];

fn starts(scale: &Scale) -> Vec<Vec<f64>> {
    [0.03, 0.1, 0.3].map(|share| vec![share * scale.speed]).into()
}

/// A share of the way between the borders at each speed; where it is none the working point stays.
fn between(slip: f64, motion: &Motion, operator: &mut Operator, share: impl Fn(f64) -> f64) {
    if slip > 0.0 {
        let speeds = motion.velocity.iter().zip(&motion.acceleration);
        for (z, (velocity, acceleration)) in operator.z.iter_mut().zip(speeds) {
            *z = share((velocity + motion.lead * acceleration) / slip);
        }
    }
}

macro_rules! law {
    ($law:ident, $name:literal, $share:expr) => {
        impl Law for $law {
            fn effect(&self) -> &'static str {
                "regularised_friction"
            }

            fn name(&self) -> &'static str {
                $name
            }

            fn parameters(&self) -> &'static [Parameter] {
                &PARAMETERS
            }

            fn starts(&self, scale: &Scale) -> Vec<Vec<f64>> {
                starts(scale)
            }

            fn is_sound(&self, values: &[f64], _: &Scale) -> bool {
                values[0] >= 0.0
            }

            fn operator(&self, values: &[f64], motion: &Motion, _: Span, operator: &mut Operator) {
                between(values[0], motion, operator, $share);
            }
        }
    };
}

law!(Clamped, "clamped", |speed: f64| speed.clamp(-1.0, 1.0));
law!(Hyperbolic, "hyperbolic_tangent", f64::tanh);
law!(Arctangent, "arctangent", |speed: f64| speed.atan() / FRAC_PI_2);
