//! White noise on the output besides the equation error.
//!
//! ```text
//! y = x + n,  A x = B u + ξ   ⇒   A y = B u + ξ + A n = B u + C w,   |C|² ∝ 1 + ratio·|A|²
//! ```
//!
//! Parameter: `ratio = var n / var ξ`. Stage: disturbance. It biases least-squares estimates of `A` towards zero. Confused with:
//! coloured equation noise; distinguished from it because one ratio fixes all of `C`.
//!
//! The search starts where `A` and `C` are solved for in turn: from a biased `A` no step leads to the right one.

use super::{Card, Scene, Variant, parameter};
use crate::effect::{Effect, Stage};

pub(super) const CARD: Card = Card {
    confounded_effects: &[Effect::ColouredNoise],
    noise: true,
    ..Card::of(Stage::Disturbance, variants)
};

fn variants(_: &Scene<'_>) -> Vec<Variant> {
    let starts = [-1.0, 1.5]
        .iter()
        .map(|&r| vec![parameter("log_ratio", "ln variance ratio", r, (-7.0, 9.0), 0.02)])
        .collect();
    vec![Variant::conditional(starts, |p, augmented| augmented.noise.output_ratio = p[0].exp())]
}
