//! The input that acts is the recorded one plus noise.
//!
//! ```text
//! var w(t) = σ²·(1 + Σⱼ b̃ⱼ²·(r₁·slope²(t−j) + r₂·gap²(t−j)))                    small noise
//! the same by slope, a miss kept until the next move                               positioning errors
//! var w(t) = σ²·(1 + Σⱼ b̃ⱼ²·r)                                                     noise added to u, a drive's
//! E u = p·C_asc(v) + (1−p)·C_desc(v),  p = P(v + n rises),  var u = s²·slope² + p(1−p)·gap²   jitter n of sd s
//! ```
//!
//! Parameters: variance ratios `r₁` while moving (by the border's slope) and `r₂` while resting (by the distance between the
//! borders, which noise makes the operator switch between), or `r` at any time; or the jitter's standard deviation `s` in strokes and the
//! inverse variance of the equation error. The colour that the response gives the noise counts as well. Stage: input. Confused with:
//! outliers, and coloured noise, which what is added to `u` is at order 2.

use crate::model::augmented::InputNoise;

use super::{Card, Scene, Search, Variant, parameter};
use crate::effect::{Effect, Stage};

pub(super) const CARD: Card = Card {
    confounded_effects: &[Effect::Outliers, Effect::ColouredNoise],
    noise: true,
    errors_last: true,
    ..Card::of(Stage::Input, variants)
};

fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    vec![small(), kept(), direct(), jitter(scene)]
}

fn jitter(scene: &Scene<'_>) -> Variant {
    let precision = -scene.fit.variance.max(1e-12).ln();
    let starts = [0.003_f64, 0.012, 0.05]
        .iter()
        .map(|s| {
            vec![
                parameter("log_jitter", "ln strokes", s.ln(), (-9.0, -1.0), 0.7),
                parameter("log_precision", "ln inverse variance", precision + 1.0, (-10.0, 25.0), 1.0),
            ]
        })
        .collect();
    let mut variant = Variant::new(starts, |p, augmented| {
        augmented.jitter = p[0].exp();
        let flips = p[1].exp();
        let by_slope = flips * augmented.jitter.powi(2);
        augmented.noise.input = Some(InputNoise { by_slope, by_gap: flips, ..InputNoise::default() });
    });
    variant.search = Search::Profile;
    variant
}

fn kept() -> Variant {
    let starts = [0.0, 2.5, 5.0, 7.5]
        .iter()
        .map(|&ratio| vec![parameter("log_ratio", "ln variance ratio", ratio, (-12.0, 14.0), 1.0)])
        .collect();
    let mut variant = Variant::new(starts, |p, augmented| {
        augmented.noise.input =
            Some(InputNoise { by_slope: p[0].exp(), kept: true, ..InputNoise::default() });
    });
    variant.search = Search::Weights;
    variant
}

fn direct() -> Variant {
    let starts = [-1.0, 2.0, 5.0]
        .iter()
        .map(|&ratio| vec![parameter("log_ratio", "ln variance ratio", ratio, (-8.0, 14.0), 1.0)])
        .collect();
    let mut variant = Variant::new(starts, |p, augmented| {
        augmented.noise.input = Some(InputNoise { direct: p[0].exp(), ..InputNoise::default() });
    });
    variant.search = Search::Weights;
    variant
}

fn small() -> Variant {
    let starts = [(0.0, -12.0), (3.0, -12.0), (6.0, -12.0), (2.0, -1.0)]
        .iter()
        .map(|&(moving, resting)| {
            vec![
                parameter("log_ratio_moving", "ln variance ratio", moving, (-12.0, 14.0), 1.0),
                parameter("log_ratio_resting", "ln variance ratio", resting, (-12.0, 8.0), 1.5),
            ]
        })
        .collect();
    let mut variant = Variant::new(starts, |p, augmented| {
        augmented.noise.input =
            Some(InputNoise { by_slope: p[0].exp(), by_gap: p[1].exp(), ..InputNoise::default() });
    });
    // The ratios act on the weights only: the innovations have no derivative that would lead to them.
    variant.search = Search::Weights;
    variant
}
