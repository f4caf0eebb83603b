//! Both experiments in one regression.

use super::experiments::{Experiments, first_level_value, satellite_value};
use super::layout::Layout;
use super::level_rule::LevelRule;

/// Descendant and ascendant experiment together: `a` and `b` shared, a constant column instead of step experiments.
///
/// ```text
/// y(t) = −Σᵢ aᵢ y(t−i) + κ + Σᵢ bᵢ w(t−i) + ξ(t),   κ = B(1)u_m
/// ```
///
/// where `w = u − u_m` is known to be 0 and 1 at the ends and `bᵢ w` is a free mean for every other (level, lag); then rank one
/// as in (3.24b) with the shared `b̂`. The constant makes a mean output from a step experiment, and its transient, needless.
/// Consistent for white equation error. An offset that differs between the two records would bias it.
///
pub(super) fn layout(experiments: &Experiments<'_>) -> Layout {
    let of_experiment = |e: usize| {
        let part = experiments.parts[e];
        let plus = satellite_value(part.branch);
        let inner = (1..part.points())
            .map(|j| LevelRule::RankOne { first: experiments.rank_free_local(e, j, 1), plus });
        std::iter::once(LevelRule::Known(first_level_value(part.branch))).chain(inner).collect()
    };
    Layout {
        columns: experiments.rank_free_columns(),
        levels: (0..experiments.parts.len()).map(of_experiment).collect(),
    }
}
