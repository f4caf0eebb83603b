//! The rank-one constrained estimator, at the Cramér–Rao bound.

use super::arrow::{ArrowFit, Columns, LocalColumn};
use super::data::PulseData;
use super::experiments::Experiments;
use super::fit::PulseFitError;
use super::joint;
use super::layout::Layout;
use super::level_rule::LevelRule;
use super::solution::{Level, Solution};
use nalgebra::DVector;

/// A change of the parameters below this share of their size ends the iteration.
pub(super) const CONVERGED: f64 = 1e-12;
/// Gauss–Newton from a consistent start needs two to five steps; more means that the record says little.
pub(super) const MOST_STEPS: usize = 30;

/// Least squares under the rank-one constraint: `a`, `b`, the level `κ` and the border values themselves.
///
/// ```text
/// y(t) = −Σᵢ aᵢ y(t−i) + κ + Σᵢ bᵢ w(t−i) + ξ(t),   w(t) ∈ {0, 1, w₂…w_m of each experiment}
/// ```
///
/// Gauss–Newton on the sufficient statistics, started from the over-parameterised estimate and run to convergence; for Gaussian
/// white equation error this is the conditional maximum likelihood, whose variance reaches the Cramér–Rao bound of `(a, b, w, κ)`. The
/// bilinear mean is linearised as `bᵢw ≈ b̄ᵢw + bᵢw̄ − b̄ᵢw̄`. Takes one experiment or both.
///
/// # Errors
/// [`PulseFitError`] if the experiments do not excite every parameter.
///
/// # Panics
/// If no experiment is given.
pub(crate) fn efficient(experiments: &[&PulseData]) -> Result<Solution, PulseFitError> {
    let experiments = Experiments::new(experiments);
    let start = joint::layout(&experiments);
    let fit = experiments.solve(&start.columns)?;
    let n = experiments.order();
    let mut b: DVector<f64> = fit.core.rows(n, n).into_owned();
    let estimated = start.levels.iter().flatten().filter(|rule| rule.rank_one().is_some());
    let mut w: Vec<f64> = estimated.map(|rule| rule.read(&fit, n).0).collect();
    let mut columns = constrained_columns(&experiments);
    linearise(&mut columns, &b, &w);
    let mut fit = experiments.solve(&columns)?;
    for _ in 0..MOST_STEPS {
        let moved = update(&fit, &mut b, &mut w);
        if moved < CONVERGED {
            break;
        }
        linearise(&mut columns, &b, &w);
        fit = experiments.solve(&columns)?;
    }
    let levels = constrained_levels(&start.levels);
    Solution::new(&experiments, Layout { columns, levels }, fit, Level::Constant)
}

/// The columns of the constrained regression: one local column an estimated level. [`linearise`] sets the weights.
pub(super) fn constrained_columns(experiments: &Experiments<'_>) -> Columns {
    let support =
        |e, level| (1..=experiments.order()).map(move |lag| (experiments.group(e, level, lag), 0.0));
    let inner = |(e, part): (usize, &&PulseData)| (1..part.points()).map(move |level| (e, level));
    let levels = experiments.parts.iter().enumerate().flat_map(inner);
    Columns {
        local: levels.map(|(e, level)| LocalColumn { support: support(e, level).collect() }).collect(),
        bilinear: true,
        ..experiments.rank_free_columns()
    }
}

/// Linearises the columns about `b` and the estimated levels `w`.
fn linearise(Columns { shared, local, offset, .. }: &mut Columns, b: &DVector<f64>, w: &[f64]) {
    for (column, w) in local.iter_mut().zip(w) {
        for (lag, ((q, weight), b)) in column.support.iter_mut().zip(b).enumerate() {
            shared[(*q, lag)] = *w;
            offset[*q] = -b * w;
            *weight = *b;
        }
    }
}

/// Takes over the new parameters; returns the largest change relative to the largest `b`, or to the level.
fn update(fit: &ArrowFit, b: &mut DVector<f64>, w: &mut [f64]) -> f64 {
    let new_b = fit.core.rows(b.len(), b.len()).into_owned();
    let mut moved = (&new_b - &*b).amax() / new_b.amax();
    *b = new_b;
    for (old, &new) in w.iter_mut().zip(&fit.local) {
        moved = moved.max((new - *old).abs() / new.abs().max(1.0));
        *old = new;
    }
    moved
}

/// The levels of the constrained regression: one local column each in place of the free means of the start.
pub(super) fn constrained_levels(start: &[Vec<LevelRule>]) -> Vec<Vec<LevelRule>> {
    let mut next = 0;
    let mut constrained = |rule: &LevelRule| match rule {
        LevelRule::RankOne { .. } => {
            next += 1;
            LevelRule::Local(next - 1)
        }
        other => *other,
    };
    start.iter().map(|rules| rules.iter().map(&mut constrained).collect()).collect()
}
