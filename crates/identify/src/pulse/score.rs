//! The score of other statistics at a regression's parameters, and their profile score: what the noise of the local columns adds to it.

use super::arrow::{ArrowFit, Columns, Response};
use super::grouped::GroupedStatistics;
use nalgebra::DVector;

/// The leading terms of the error of every parameter: `a`, `b`, then the points of each border.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ErrorTerms {
    /// First order in the noise.
    pub first: Vec<f64>,
    /// Of the second order, as much as was [asked for](super::SecondOrder).
    pub second: Vec<f64>,
}

/// A group sum `S_q,l = Σ_{t∈q} y(t−l)`: groups counted through all experiments of a method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct GroupSum {
    /// `q`.
    pub group: usize,
    /// `l`.
    pub lag: usize,
}

/// `Cov(S_q,i, S_p,l)` over all noise.
pub(crate) type Covariance<'a> = &'a dyn Fn(GroupSum, GroupSum) -> f64;

impl ArrowFit {
    /// `M⁻¹s`: this regression's answer to the score `s = S_{Φy} − Sθ₀` of other statistics, with `θ₀` and `M` its own.
    pub(crate) fn response_to_score(&self, statistics: &GroupedStatistics, columns: &Columns) -> Response {
        let n = statistics.order();
        let a = self.core.rows(0, n);
        let mut lagged: Vec<f64> = (1..=n)
            .map(|i| {
                -statistics.product(0, i) - (0..n).map(|l| a[l] * statistics.product(i, l + 1)).sum::<f64>()
            })
            .collect();
        for (q, mean) in self.group_means(columns).into_iter().enumerate() {
            for (i, lagged) in lagged.iter_mut().enumerate() {
                *lagged += mean * statistics.sum(q, i + 1);
            }
        }
        self.respond(columns, &self.residual_sums(statistics, columns), &lagged)
    }

    /// `Σ_{t∈q} r(t)` of other statistics, `r` the residual at this regression's parameters.
    pub(super) fn residual_sums(&self, statistics: &GroupedStatistics, columns: &Columns) -> Vec<f64> {
        let residual = |(q, mean): (usize, f64)| {
            let past: f64 = (0..statistics.order()).map(|l| self.core[l] * statistics.sum(q, l + 1)).sum();
            statistics.sum(q, 0) + past - mean * statistics.count(q)
        };
        self.group_means(columns).into_iter().enumerate().map(residual).collect()
    }

    /// The profile score of other statistics less their score, at this regression's parameters.
    ///
    /// With the local columns eliminated, a target `s_l` of theirs reaches the core through `ĉ_l/D_l`, where `ĉ_l` holds sums of the noisy
    /// output. The score has its expectation in this place:
    ///
    /// ```text
    /// −Σ_l (ĉ_l/D_l − E[c_l]/E[D_l]) s_l                                       on a
    ///  Σ_l δ_l (r_q(l,i) − bᵢ K_q(l,i) δ_l),   δ_l = s_l/D_l, on bᵢ            where the columns are bilinear
    /// ```
    ///
    /// Quadratic in the noise: its mean is that of products of two group sums.
    pub(crate) fn profile_shift(&self, statistics: &GroupedStatistics, columns: &Columns) -> DVector<f64> {
        let n = statistics.order();
        let residual = self.residual_sums(statistics, columns);
        let mut shift = DVector::zeros(self.core.len());
        for (column, tie) in columns.local.iter().zip(&self.ties) {
            let own: f64 = column.support.iter().map(|&(q, w)| w * w * statistics.count(q)).sum();
            let target = column.target(&residual);
            for i in 0..n {
                let cross: f64 = column.support.iter().map(|&(q, w)| -w * statistics.sum(q, i + 1)).sum();
                shift[i] -= (cross / own - tie.slope[i]) * target;
            }
            if columns.bilinear {
                let change = target / own;
                for (i, &(q, w)) in column.support.iter().enumerate() {
                    shift[n + i] += change * (residual[q] - w * statistics.count(q) * change);
                }
            }
        }
        shift
    }

    /// The mean of [`Self::profile_shift`] over all noise, given expected statistics and the covariances of their sums: exact, because a
    /// product's mean is the product of the means and the covariance.
    pub(crate) fn mean_profile_shift(
        &self,
        expected: &GroupedStatistics,
        columns: &Columns,
        covariance: Covariance<'_>,
    ) -> DVector<f64> {
        let n = expected.order();
        let mut mean = self.profile_shift(expected, columns);
        let coefficient = |l: usize| if l == 0 { 1.0 } else { self.core[l - 1] };
        let with_residual = |sum: GroupSum, q: usize| {
            (0..=n).map(|lag| coefficient(lag) * covariance(sum, GroupSum { group: q, lag })).sum::<f64>()
        };
        for column in &columns.local {
            let own: f64 = column.support.iter().map(|&(q, w)| w * w * expected.count(q)).sum();
            let with_target =
                |sum: GroupSum| column.support.iter().map(|&(q, w)| w * with_residual(sum, q)).sum::<f64>();
            for i in 0..n {
                let crossing = |&(q, w): &(usize, f64)| w * with_target(GroupSum { group: q, lag: i + 1 });
                mean[i] += column.support.iter().map(crossing).sum::<f64>() / own;
            }
            if columns.bilinear {
                let residual_with_target = |q: usize| {
                    (0..=n).map(|lag| coefficient(lag) * with_target(GroupSum { group: q, lag })).sum::<f64>()
                };
                let target: f64 = column.support.iter().map(|&(q, w)| w * residual_with_target(q)).sum();
                for (i, &(q, w)) in column.support.iter().enumerate() {
                    mean[n + i] += (residual_with_target(q) - w * expected.count(q) * target / own) / own;
                }
            }
        }
        mean
    }
}
