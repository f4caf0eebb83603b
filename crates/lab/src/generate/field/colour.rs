//! The colour of a machine's equation noise.

use crate::generate::effects::card;
use crate::generate::law::{Amount, Law, Nature, Scene};
use std::f64::consts::PI;

/// AR(2) with drawn poles, of which the slower has the radius `x`: `ξ'(t) = −d₁ξ'(t−1) − d₂ξ'(t−2) + ξ(t)`.
///
/// Every other time both are real, the second −0.4 to 0.7 of the first; else they are a pair at 0.02 to 0.5 of half the sampling rate.
#[derive(Debug)]
pub(super) struct Colour;

impl Law for Colour {
    card!("coloured_noise", "AR(2), drawn poles", Disturbance, "pole radius", 0.995);

    fn nature(&self) -> Nature {
        Nature::Noise
    }

    fn equation_error(&self, scene: &mut Scene<'_>, _u: &[f64], xi: &mut [f64]) {
        let [_, d1, d2] = denominator(&scene.amount);
        for t in 0..xi.len() {
            let past = |i: usize| if t >= i { xi[t - i] } else { 0.0 };
            xi[t] -= d1 * past(1) + d2 * past(2);
        }
    }
}

/// `1, d₁, d₂`.
pub(super) fn denominator(amount: &Amount) -> [f64; 3] {
    let radius = amount.magnitude;
    if amount.shape[0] < 0.5 {
        let second = radius * amount.between(1, -0.4, 0.7);
        [1.0, -(radius + second), radius * second]
    } else {
        let angle = PI * amount.between(1, 0.02, 0.5);
        [1.0, -2.0 * radius * angle.cos(), radius * radius]
    }
}
