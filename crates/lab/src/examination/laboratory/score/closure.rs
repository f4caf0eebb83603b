//! How far: stated closure against the closure that the stated models have.

use crate::blind::case::Case;
use crate::blind::design::Kind;
use crate::examination::{ClosureCheck, Share};

/// Closure of the rigs of one effect.
#[derive(Debug, Clone, PartialEq)]
pub struct ClosureRow {
    /// The effect put in; pairs together.
    pub effect: &'static str,
    /// Rigs that came with a closure.
    pub rigs: usize,
    /// Mean of what was stated.
    pub stated: f64,
    /// Mean of what the stated models really close; a model that knows the effect closes all of it, 1.
    pub actual: f64,
    /// Intervals that hold what the models really close.
    pub coverage: Share,
    /// Mean absolute error of what was stated.
    pub error: f64,
}

pub(super) fn rows(cases: &[Case]) -> Vec<ClosureRow> {
    let mut effects: Vec<&'static str> = cases.iter().filter_map(label).collect();
    effects.sort_unstable();
    effects.dedup();
    effects
        .into_iter()
        .filter_map(|effect| {
            let checks: Vec<ClosureCheck> =
                cases.iter().filter(|c| label(c) == Some(effect)).filter_map(|c| c.closure).collect();
            let mean = |f: fn(&ClosureCheck) -> f64| mean(checks.iter().map(f));
            Some(ClosureRow {
                effect,
                rigs: checks.len(),
                stated: mean(|c| c.estimate)?,
                actual: mean(|c| c.actual)?,
                coverage: coverage(checks.iter()),
                error: mean(ClosureCheck::error)?,
            })
        })
        .collect()
}

fn label(case: &Case) -> Option<&'static str> {
    match case.kind {
        Kind::Single => case.truth.first().copied(),
        Kind::Pair => Some("(pairs)"),
        Kind::None | Kind::Outside => None,
    }
}

/// Intervals that hold the truth.
pub(super) fn coverage<'a>(checks: impl Iterator<Item = &'a ClosureCheck>) -> Share {
    checks.fold(Share::default(), |s, c| Share { count: s.count + usize::from(c.is_covered()), of: s.of + 1 })
}

/// Mean; none of nothing.
pub(super) fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0_usize), |(sum, count), x| (sum + x, count + 1));
    (count > 0).then(|| sum / count as f64)
}
