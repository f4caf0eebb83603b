//! The rank-one constrained estimator, at the Cramér–Rao bound.

use super::arrow::{ArrowFit, Columns, Gradient, LocalColumn};
use super::data::PulseData;
use super::experiments::{Experiments, Seen, first_level_value};
use super::fit::PulseFitError;
use super::joint::rank_free_levels;
use super::solution::{Level, RelativeLevel, Solution, known_level};
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
    let start = experiments.solve(&experiments.rank_free_columns())?;
    let n = experiments.order();
    let mut b: DVector<f64> = start.core.rows(n, n).into_owned();
    let mut w: Vec<Vec<f64>> = rank_free_levels(&experiments, &start)
        .into_iter()
        .map(|levels| levels.into_iter().map(|level| level.value).collect())
        .collect();
    let mut columns = linearised(&experiments, &b, &w);
    let mut fit = experiments.solve(&columns)?;
    for _ in 0..MOST_STEPS {
        let moved = update(&experiments, &fit, &mut b, &mut w);
        if moved < CONVERGED {
            break;
        }
        columns = linearised(&experiments, &b, &w);
        fit = experiments.solve(&columns)?;
    }
    let levels = constrained_levels(&experiments, &fit);
    Solution::new(&experiments, columns, fit, levels, Level::Constant)
}

/// The regression linearised about `b` and `w`.
fn linearised(experiments: &Experiments<'_>, b: &DVector<f64>, w: &[Vec<f64>]) -> Columns {
    let n = experiments.order();
    let shared = experiments.core_columns(|e, level| w[e][level]);
    let mut offset = vec![0.0; experiments.statistics.groups()];
    for (group, e, seen) in experiments.groups() {
        if let Seen::Level { level: level @ 1.., lag } = seen {
            offset[group] = -b[lag - 1] * w[e][level];
        }
    }
    let local = experiments
        .parts
        .iter()
        .enumerate()
        .flat_map(|(e, part)| (1..part.points()).map(move |level| (e, level)))
        .map(|(e, level)| LocalColumn {
            support: (1..=n).map(|lag| (experiments.group(e, level, lag), b[lag - 1])).collect(),
        })
        .collect();
    Columns { shared, local, offset, bilinear: true }
}

/// Takes over the new parameters; returns the largest change relative to the largest value.
fn update(experiments: &Experiments<'_>, fit: &ArrowFit, b: &mut DVector<f64>, w: &mut [Vec<f64>]) -> f64 {
    let n = experiments.order();
    let new_b = fit.core.rows(n, n).into_owned();
    let mut moved = (&new_b - &*b).amax() / new_b.amax();
    *b = new_b;
    let mut local = fit.local.iter();
    for levels in w.iter_mut() {
        for (old, &new) in levels.iter_mut().skip(1).zip(local.by_ref()) {
            moved = moved.max((new - *old).abs() / new.abs().max(1.0));
            *old = new;
        }
    }
    moved
}

fn constrained_levels(experiments: &Experiments<'_>, fit: &ArrowFit) -> Vec<Vec<RelativeLevel>> {
    let mut next = 0..fit.local.len();
    experiments
        .parts
        .iter()
        .map(|part| {
            let mut levels = vec![known_level(fit, first_level_value(part.branch))];
            levels.extend(next.by_ref().take(part.points() - 1).map(|l| RelativeLevel {
                value: fit.local[l],
                gradient: Gradient { core: DVector::zeros(fit.core.len()), local: vec![(l, 1.0)] },
                free_means: None,
            }));
            levels
        })
        .collect()
}
