//! The input that acts is the recorded one plus noise.
//!
//! ```text
//! var w(t) = σ²·(1 + Σⱼ b̃ⱼ²·(r₁·slope²(t−j) + r₂·gap²(t−j)))
//! ```
//!
//! Parameters: variance ratios `r₁` while moving (by the border's slope) and `r₂` while resting (by the distance between the borders,
//! which noise makes the operator switch between). Stage: input. Confused with: outliers.

use super::{Search, Variant, own};

pub(super) fn variants() -> Vec<Variant> {
    let starts = [(0.0, -12.0), (3.0, -12.0), (6.0, -12.0), (2.0, -1.0)]
        .iter()
        .map(|&(moving, resting)| {
            vec![
                own("log_ratio_moving", "ln variance ratio", moving, (-12.0, 14.0), 1.0),
                own("log_ratio_resting", "ln variance ratio", resting, (-12.0, 8.0), 1.5),
            ]
        })
        .collect();
    let mut variant = Variant::new(starts, |p, assembly| {
        assembly.noise.input_ratio = Some([p[0].exp(), p[1].exp()]);
    });
    // The ratios act on the weights only: the innovations have no derivative that would lead to them.
    variant.search = Search::Profile;
    vec![variant]
}
