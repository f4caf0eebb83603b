//! One or two pulse experiments under one regression.

use super::arrow::{ArrowFit, Columns, LocalColumn, NotExcited, Score};
use super::data::PulseData;
use super::grouped::GroupedStatistics;
use nalgebra::DMatrix;
use switchback_model::hysteresis::Branch;

/// Experiments side by side: their statistics about one reference, their groups one after the other.
///
/// The core columns are `b₁…bₙ` and, if there is one, the constant `κ = B(1)·u_m` of the experiment's level. In the normalisation
/// `u_M − u_m = 1` the input is `u = u_m + w` with `w` between: the satellite is `w = 1` for a descendant experiment and `w = 0` for an
/// ascendant one, and `V₁` is the other of the two.
pub(crate) struct Experiments<'a> {
    pub(crate) parts: Vec<&'a PulseData>,
    pub(crate) statistics: GroupedStatistics,
    pub(crate) reference: f64,
}

/// Steps of iterative refinement: each multiplies the error by the condition number times 1e-16, two reach what QR would.
const REFINEMENTS: usize = 2;

/// One group, named: which experiment it belongs to, and what its lag window saw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Seen {
    /// The satellite at every lag.
    Satellite,
    /// Level `V_{level+1}` at `lag` (from 1).
    Level { level: usize, lag: usize },
}

impl<'a> Experiments<'a> {
    /// Stacks experiments of the same order about the first one's reference.
    pub(crate) fn new(parts: &[&'a PulseData]) -> Self {
        let reference = parts[0].reference;
        let statistics = match parts {
            [only] => only.statistics.clone(),
            several => {
                let about: Vec<GroupedStatistics> = several
                    .iter()
                    .map(|part| {
                        if part.reference == reference {
                            part.statistics.clone()
                        } else {
                            part.about(reference).statistics
                        }
                    })
                    .collect();
                GroupedStatistics::stacked(&about.iter().collect::<Vec<_>>())
            }
        };
        Self { parts: parts.to_vec(), statistics, reference }
    }

    pub(crate) fn order(&self) -> usize {
        self.statistics.order()
    }

    /// Every group with its index, experiment and meaning.
    pub(crate) fn groups(&self) -> impl Iterator<Item = (usize, usize, Seen)> + '_ {
        let order = self.order();
        self.parts
            .iter()
            .enumerate()
            .flat_map(move |(e, part)| {
                std::iter::once((e, Seen::Satellite)).chain(
                    (0..part.points())
                        .flat_map(move |level| (1..=order).map(move |lag| (e, Seen::Level { level, lag }))),
                )
            })
            .enumerate()
            .map(|(group, (e, seen))| (group, e, seen))
    }

    /// Index of a level's group.
    pub(crate) fn group(&self, experiment: usize, level: usize, lag: usize) -> usize {
        let before: usize = self.parts[..experiment].iter().map(|p| p.statistics.groups()).sum();
        before + PulseData::group(self.order(), level, lag)
    }

    /// Solves a regression over these experiments, refined on the records where they are at hand.
    pub(crate) fn solve(&self, columns: &Columns) -> Result<ArrowFit, NotExcited> {
        let mut fit = ArrowFit::solve(&self.statistics, columns)?;
        for _ in 0..REFINEMENTS {
            let Some(score) = self.score(&fit, columns) else { break };
            fit.refine(columns, &score);
        }
        Ok(fit)
    }

    /// Residuals of a fit summed over the records themselves; `None` where an experiment has statistics only.
    fn score(&self, fit: &ArrowFit, columns: &Columns) -> Option<Score> {
        let n = self.order();
        let means = fit.group_means(columns);
        let mut score = Score { residual: vec![0.0; means.len()], lagged: vec![0.0; n], energy: 0.0 };
        let mut first_group = 0;
        for part in &self.parts {
            let rows = part.rows.as_ref()?;
            for (window, &q) in rows.y.windows(n + 1).zip(&rows.groups) {
                let lag = |i: usize| window[n - i] - self.reference;
                let r =
                    lag(0) + (1..=n).map(|i| fit.core[i - 1] * lag(i)).sum::<f64>() - means[first_group + q];
                score.residual[first_group + q] += r;
                score.energy += r * r;
                for i in 1..=n {
                    score.lagged[i - 1] -= lag(i) * r;
                }
            }
            first_group += part.statistics.groups();
        }
        Some(score)
    }

    /// Core columns `b₁…bₙ, κ` for given `w` at every level: `Σᵢ bᵢ w(t−i) + κ`.
    pub(crate) fn core_columns(&self, w: impl Fn(usize, usize) -> f64) -> DMatrix<f64> {
        let n = self.order();
        let mut shared = DMatrix::zeros(self.statistics.groups(), n + 1);
        for (group, e, seen) in self.groups() {
            let rest = satellite_value(self.parts[e].branch);
            for i in 0..n {
                shared[(group, i)] = rest;
            }
            if let Seen::Level { level, lag } = seen {
                shared[(group, lag - 1)] = w(e, level);
            }
            shared[(group, n)] = 1.0;
        }
        shared
    }

    /// The regression with a free mean for every (level, lag) but `V₁`'s: the paper's over-parameterised one with a
    /// constant column. Local column `rank_free_local(e, j, i)` holds `h = bᵢ(w_j − satellite)`.
    pub(crate) fn rank_free_columns(&self) -> Columns {
        let shared = self.core_columns(|e, level| match level {
            0 => first_level_value(self.parts[e].branch),
            _ => satellite_value(self.parts[e].branch),
        });
        let local = self
            .groups()
            .filter(|(_, _, seen)| matches!(seen, Seen::Level { level, .. } if *level > 0))
            .map(|(group, _, _)| LocalColumn::own(group))
            .collect();
        Columns { shared, local, offset: vec![0.0; self.statistics.groups()], bilinear: false }
    }

    /// Index of the local column of level `level ≥ 1` (from 0) of an experiment at `lag`, in [`Self::rank_free_columns`].
    pub(crate) fn rank_free_local(&self, experiment: usize, level: usize, lag: usize) -> usize {
        let before: usize = self.parts[..experiment].iter().map(|p| p.points() - 1).sum();
        (before + level - 1) * self.order() + lag - 1
    }
}

/// `w` at the satellite.
pub(crate) fn satellite_value(branch: Branch) -> f64 {
    match branch {
        Branch::Descending => 1.0,
        Branch::Ascending => 0.0,
    }
}

/// `w` at `V₁`.
pub(crate) fn first_level_value(branch: Branch) -> f64 {
    1.0 - satellite_value(branch)
}
