//! Rare large errors.
//!
//! ```text
//! w ~ (1−ε)·N(0, σ²) + ε·N(0, κ²σ²)
//! ```
//!
//! Parameters: share `ε` and ratio `κ`, found by expectation–maximisation. Stage: disturbance. Heavy tails without a place.
//! Confused with: input noise, a border jump between grid points.

use super::{Card, Follows, Reading, Scene, Variant, known};
use crate::effect::{Effect, Stage};
use crate::fitted_parameter::FittedParameter;
use crate::records::dataset::ScaledRecord;

pub(super) const CARD: Card = Card {
    confounded_effects: &[Effect::InputNoise],
    noise: true,
    heavy_tails: true,
    follows: Some(Follows::Anything),
    catch_all: true,
    // They come whatever the machine does: nothing of them hangs on its state.
    reported_first: share_and_size,
    ..Card::of(Stage::Disturbance, variants)
};

/// Exact repeats of the last output, as a share of the samples, that chance does not make: a sensor that holds its value
/// leaves large errors too, but is another cause.
const REPEATS: f64 = 0.004;

fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    let outputs = || scene.dataset.fit().flat_map(|scaled| scaled.y.iter().copied());
    let (least, most) =
        (outputs().fold(f64::INFINITY, f64::min), outputs().fold(f64::NEG_INFINITY, f64::max));
    // At its limits a clipping sensor repeats itself, too.
    let inside = |y: f64| least < y && y < most;
    let repeated =
        |scaled: &ScaledRecord| scaled.y.windows(2).filter(|w| w[0] == w[1] && inside(w[0])).count();
    let repeats: usize = scene.dataset.fit().map(repeated).sum();
    let count = outputs().count();
    let rounding_is_known = scene.fit.augmented.noise.quantisation.is_some();
    if !rounding_is_known && repeats as f64 > REPEATS * count as f64 {
        return Vec::new();
    }
    let mut variant =
        Variant::new(vec![Vec::new()], |_, augmented| augmented.noise.mixture = Some((0.01, 8.0)));
    // Two parameters that expectation–maximisation finds outside the count.
    variant.size_penalty = 20.0;
    vec![variant]
}

fn share_and_size(reading: &Reading<'_>) -> Vec<FittedParameter> {
    let reported = |(share, ratio): (f64, f64)| {
        [known("share", "1", share), known("ratio", "sd of the other errors", ratio)]
    };
    reading.fit.augmented.noise.mixture.into_iter().flat_map(reported).collect()
}
