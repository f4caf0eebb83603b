//! The sensor rounds.
//!
//! ```text
//! y = q·round(x/q): all differences of y are multiples of q; rounding adds noise of variance q²/12 to the output
//! ```
//!
//! Parameter: the step `q`, read off the quantisation grid. Stage: sensor. Confused with: output noise, which leaves no quantisation grid.
//! A quantisation grid too fine to matter is no cause.

use super::{Card, Scene, Variant};
use crate::effect::Stage;
use crate::residuals::quantisation_grid::{is_material, quantisation_step, worth};

pub(super) const CARD: Card = Card {
    errors_last: true,
    misreads: true,
    rounds: true,
    reported_first: |reading| {
        let step = reading.fit.augmented.noise.quantisation;
        step.map(|step| reading.step("step", step)).into_iter().collect()
    },
    ..Card::of(Stage::Sensor, variants)
};

fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    let Some(step) = quantisation_step(scene.dataset).filter(|step| is_material(*step, scene.fit)) else {
        return Vec::new();
    };
    let ratio = super::parameter("log_ratio", "ln variance ratio", 0.0, (-7.0, 9.0), 0.02);
    let mut variant = Variant::new(vec![vec![ratio]], move |p, augmented| {
        augmented.noise.output_ratio = p[0].exp();
        augmented.noise.quantisation = Some(step);
    });
    variant.size_penalty = -worth(scene.dataset.fit_samples());
    vec![variant]
}
