//! The mean of the noise over the first N samples, for several N at once, without the samples.

use super::plan::{NoisePlan, NoisePlanError};
use super::white::{BLOCK, StreamId, WhiteNoise};
use super::width::Width;
use nalgebra::{Cholesky, DMatrix};
use std::ops::Range;
use switchback_model::linear::SumVariance;

/// Draws the means of `e(0) … e(N−1)` at all checkpoints N of a plan from their joint law.
///
/// Of a step experiment the estimators use nothing but its mean. The partial sums `S_N` of stationary noise have stationary increments, so
/// with `V(N) = Var S_N`
///
/// ```text
/// V(N) = N γ(0) + 2 Σ_{k=1}^{N−1} (N−k) γ(k)          γ the autocovariances of e = C/A w
/// Cov(S_N, S_M) = ½ (V(N) + V(M) − V(|M−N|))
/// ```
///
/// and the means at K checkpoints are exactly `L z` row by row over N, `L` the Cholesky factor and `z` K standard normals: the law of
/// running 1/A over N samples, for the price of K. A replicate's `z` are the first normals of its [`StreamId`], so its means depend neither
/// on the width nor on its neighbours. The noise is the stationary one: the plan's burn-in, lags and periods play no part.
///
/// ```
/// # use switchback_noise::{MeanNoise, NoisePlan, Width};
/// let plan = NoisePlan {
///     ar: vec![-0.5], ma: vec![], lags: 0, periods: vec![1], checkpoints: vec![100, 10_000], burn_in: 0,
/// };
/// let mut squares = 0.0;
/// MeanNoise::new(&plan)?.draw(Width::detect(), 1, 2, 0..2000, |_, means| squares += means[1] * means[1]);
/// // A(1) = 1/2, so the mean of N samples has a variance of nearly 4/N.
/// assert!((squares / 2000.0 * 10_000.0 - 4.0).abs() < 0.5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct MeanNoise {
    /// `L` over N, the rows of a lower triangle.
    factor: Vec<Vec<f64>>,
}

impl MeanNoise {
    /// For the filter and the checkpoints of a plan.
    ///
    /// # Errors
    /// If the plan is not valid.
    pub fn new(plan: &NoisePlan) -> Result<Self, NoisePlanError> {
        plan.validate()?;
        let longest = plan.checkpoints.last().copied().unwrap_or_default();
        let variance = SumVariance::new(&plan.ar, &plan.ma, longest);
        let n = &plan.checkpoints;
        let covariance = DMatrix::from_fn(n.len(), n.len(), |i, j| {
            (variance.at(n[i]) + variance.at(n[j]) - variance.at(n[i].abs_diff(n[j]))) / 2.0
        });
        // Each sum holds an innovation of variance 1 that the shorter ones do not, so no pivot is below 1.
        let factor = Cholesky::new(covariance).expect("sums over different numbers of samples").unpack();
        let row = |i: usize| (0..=i).map(|j| factor[(i, j)] / n[i] as f64).collect();
        Ok(Self { factor: (0..n.len()).map(row).collect() })
    }

    /// The covariance matrix of the means.
    #[cfg(test)]
    pub(super) fn covariance(&self) -> DMatrix<f64> {
        let count = self.factor.len();
        let factor =
            DMatrix::from_fn(count, count, |i, j| self.factor[i].get(j).copied().unwrap_or_default());
        &factor * factor.transpose()
    }

    /// Visits the means of every replicate, in order: one a checkpoint.
    pub fn draw(
        &self,
        width: Width,
        seed: u64,
        experiment: u32,
        replicates: Range<u32>,
        mut visit: impl FnMut(u32, &[f64]),
    ) {
        let count = self.factor.len();
        let mut noise = WhiteNoise::new(width, StreamId { seed, experiment, replicate: replicates.start });
        let lanes = noise.lanes();
        let mut normals = vec![0.0; count.next_multiple_of(BLOCK) * lanes];
        let mut means = vec![0.0; count];
        for first in replicates.clone().step_by(lanes) {
            noise.restart(experiment, first);
            normals.chunks_exact_mut(BLOCK * lanes).for_each(|block| noise.fill(block));
            for (lane, replicate) in (first..replicates.end).take(lanes).enumerate() {
                for (mean, row) in means.iter_mut().zip(&self.factor) {
                    *mean = row.iter().zip(normals[lane..].iter().step_by(lanes)).map(|(l, z)| l * z).sum();
                }
                visit(replicate, &means);
            }
        }
    }
}
