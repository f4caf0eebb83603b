//! The equation error is not white.
//!
//! ```text
//! ξ = w / D(q⁻¹), D of degree 1, 2, 4, 6, 10 or 20;   or ξ = C(q⁻¹) w, C of degree 1, 3 or 8
//! ```
//!
//! Parameters: coefficients of `D`, or of `C`. Stage: disturbance. It moves no simulation error but biases least-squares estimates of `A`.
//! Confused with: output noise.

use super::{Card, Follows, Scene, Variant, parameter};
use crate::effect::{Effect, Stage};
use switchback_model::spectrum::moving_average;

pub(super) const CARD: Card = Card {
    confounded_effects: &[Effect::OutputNoise, Effect::InputNoise],
    noise: true,
    colours_noise: true,
    dominates_dynamics: true,
    follows: Some(Follows::Anything),
    ..Card::of(Stage::Disturbance, variants)
};

fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    let mut out: Vec<Variant> = [1, 2, 4, 6, 10, 20]
        .into_iter()
        .map(|degree| {
            // A pole of the noise near one is far from white noise: the nominal A has it.
            let starts = [0.0, -0.5, -0.8, -0.95]
                .iter()
                .take(if degree > 2 { 1 } else { 4 })
                .map(|&first| {
                    let value = |i| if i == 0 { first } else { 0.0 };
                    (0..degree).map(|i| parameter("d", "1", value(i), (-2.5, 2.5), 0.003)).collect()
                })
                .collect();
            Variant::conditional(starts, |p, augmented| {
                augmented.noise.ar = crate::model::augmented::times_monic(&augmented.noise.ar, p);
            })
        })
        .collect();
    let starts = [-0.3, 0.3].iter().map(|&c| vec![parameter("c", "1", c, (-0.97, 0.97), 0.003)]).collect();
    out.push(Variant::new(starts, |p, augmented| augmented.noise.ma = vec![p[0]]));
    // Small steps from white noise do not get to zeros beside the unit circle.
    out.extend([3, 8].map(|degree| {
        let coefficients = moving_average(scene.innovations, degree);
        let start = coefficients.into_iter().map(|c| parameter("c", "1", c, (-4.0, 4.0), 0.003)).collect();
        Variant::conditional(vec![start], |p, augmented| augmented.noise.ma = p.to_vec())
    }));
    out
}
