//! The paper's own estimator, one experiment at a time.

use super::arrow::{Columns, LocalColumn};
use super::experiments::{Experiments, Seen, first_level_value, satellite_value};
use super::layout::Layout;
use super::level_rule::LevelRule;
use nalgebra::DMatrix;

/// Least squares (3.21) on `ỹ = y − ŷ₀`, rank one (3.24a–b), level from the step experiment (3.25).
///
/// ```text
/// ỹ(t) = −Σᵢ aᵢ ỹ(t−i) + Σᵢⱼ μᵢⱼ ṽ(t−i) P_j(ṽ(t−i)) + ξ(t),   μᵢⱼ = bᵢ c_j
/// b̂ᵢ = μ̂ᵢ₁/c₁,   ĉ_j = Σᵢ b̂ᵢ μ̂ᵢⱼ / Σᵢ b̂ᵢ²,   F̂(V_j) = ĉ_j W_j + Â(1)/B̂(1)·ŷ₀
/// ```
///
/// with `c₁ = −1/W₁` for the descendant experiment and `+1/W₁` for the ascendant one. Computed with `gᵢⱼ = μᵢⱼW_j`, the height of the pulse, so
/// that `b̂ᵢ = ∓ĝᵢ₁` and `ĉ_jW_j = Σ b̂ᵢĝᵢⱼ/Σ b̂ᵢ²`: the same numbers without the scaling by `W_j`. `ŷ₀` is the
/// settled mean output at the experiment's satellite, and the statistics are about it.
///
/// Consistent for white equation error; its variance exceeds the Cramér–Rao bound, because `μ = bcᵀ` has rank one and is fitted without.
///
/// One column a (level, lag): `V₁`'s are shared columns because they are `∓bᵢ` themselves, the others are free means.
pub(super) fn layout(experiments: &Experiments<'_>) -> Layout {
    let n = experiments.order();
    let branch = experiments.parts[0].branch;
    let height = first_level_value(branch) - satellite_value(branch);
    let mut shared = DMatrix::zeros(experiments.statistics.groups(), n);
    let mut local = Vec::new();
    for (group, _, seen) in experiments.groups() {
        match seen {
            Seen::Satellite => {}
            Seen::Level { level: 0, lag } => shared[(group, lag - 1)] = height,
            Seen::Level { .. } => local.push(LocalColumn::own(group)),
        }
    }
    let inner = (1..experiments.parts[0].points())
        .map(|j| LevelRule::RankOne { first: experiments.rank_free_local(0, j, 1), plus: 0.0 });
    Layout {
        levels: vec![std::iter::once(LevelRule::Known(height)).chain(inner).collect()],
        columns: Columns {
            shared,
            local,
            offset: vec![0.0; experiments.statistics.groups()],
            bilinear: false,
        },
    }
}
