//! A working point that needs travel to pass from one border to the other.

use super::super::law::{Law, Parameter, Unit};
use super::super::motion::Motion;
use super::super::scale::Scale;
use super::super::signals::{Operator, Span};

const PARAMETERS: [Parameter; 1] = [Parameter::new("transition_length", Unit::Input, (0.0, f64::INFINITY))];

/// `dz/dx = (±1 − z)/length` along the travel `x`: Dahl's law for the loop.
#[derive(Debug)]
pub(super) struct Relaxing;

/// `dz/dx = ±2/length` until the border is reached: elastic bending before slip.
#[derive(Debug)]
pub(super) struct Elastic;

fn starts(scale: &Scale) -> Vec<Vec<f64>> {
    [0.01, 0.03, 0.1, 0.25].map(|share| vec![share * scale.travel]).into()
}

fn cross(operator: &mut Operator, motion: &Motion, next: impl Fn(f64, f64, f64) -> f64) {
    let Some(mut z) = operator.z.first().copied() else { return };
    for (t, target) in operator.z.iter_mut().enumerate() {
        z = next(z, *target, motion.moved[t]).clamp(-1.0, 1.0);
        *target = z;
    }
}

impl Law for Relaxing {
    fn effect(&self) -> &'static str {
        "gradual_transition"
    }

    fn name(&self) -> &'static str {
        "relaxing"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn starts(&self, scale: &Scale) -> Vec<Vec<f64>> {
        starts(scale)
    }

    fn is_sound(&self, values: &[f64], scale: &Scale) -> bool {
        values[0] < 2.0 * scale.travel
    }

    fn operator(&self, values: &[f64], motion: &Motion, _: Span, operator: &mut Operator) {
        let length = values[0];
        if length > 0.0 {
            cross(operator, motion, |z, target, moved| target - (target - z) * (-moved / length).exp());
        }
    }
}

impl Law for Elastic {
    fn effect(&self) -> &'static str {
        "gradual_transition"
    }

    fn name(&self) -> &'static str {
        "elastic"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn starts(&self, scale: &Scale) -> Vec<Vec<f64>> {
        starts(scale)
    }

    fn is_sound(&self, values: &[f64], scale: &Scale) -> bool {
        values[0] < 2.0 * scale.travel
    }

    fn operator(&self, values: &[f64], motion: &Motion, _: Span, operator: &mut Operator) {
        let length = values[0];
        if length > 0.0 {
            cross(operator, motion, |z, target, moved| {
                let step = 2.0 * moved / length;
                z + (target - z).clamp(-step, step)
            });
        }
    }
}
