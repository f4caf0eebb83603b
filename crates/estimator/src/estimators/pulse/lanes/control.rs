//! The control variate of eight replicates: one matrix, made once.

use super::lane::Lane;
use super::statistics::LaneStatistics;
use super::wide::{Work, widest};

/// [`Limit::first_order`](super::super::Limit::first_order) as a constant linear map of the score over the number of samples.
#[derive(Debug, Clone)]
pub struct LaneControl {
    /// What the limit was taken about.
    pub(crate) reference: f64,
    /// The limit's `a`.
    pub(crate) a: Vec<f64>,
    /// The limit's mean of each group.
    pub(crate) means: Vec<f64>,
    /// One row a parameter, over the score: `n` lags, then the groups.
    pub(crate) map: Vec<f64>,
    /// Derivative of each parameter in `ŷ₀`.
    pub(crate) step_slopes: Vec<f64>,
    /// `ŷ₀` at the limit.
    pub(crate) step_mean: f64,
}

impl LaneControl {
    /// The first-order part of every parameter's error, into `first_order`; `score` is scratch.
    pub fn first_order(
        &self,
        parts: &[&LaneStatistics],
        step_mean: Option<Lane>,
        score: &mut Vec<Lane>,
        first_order: &mut Vec<Lane>,
    ) {
        widest(FirstOrder { control: self, parts, step_mean, score, first_order });
    }

    /// `Σ_t −y(t−i) r(t)` a lag and `Σ_{t∈q} r(t)` a group, with `r` the residual at the limit's parameters.
    #[inline(always)]
    fn score(&self, parts: &[&LaneStatistics], score: &mut Vec<Lane>) {
        let n = self.a.len();
        let reference = Lane::splat(self.reference);
        score.clear();
        score.resize(n, Lane::ZERO);
        let mut limit_means = self.means.iter();
        for part in parts {
            for i in 0..n {
                let row = &part.within[(i + 1) * (n + 1)..];
                let mut sum = row[0];
                for (a, w) in self.a.iter().zip(&row[1..]) {
                    sum += *w * *a;
                }
                score[i] -= sum;
            }
            for ((group, &count), limit) in part.counts.iter().enumerate().zip(&mut limit_means) {
                let mean = part.mean(group);
                let mut residual = mean[0] - reference - Lane::splat(*limit);
                for (a, mean) in self.a.iter().zip(&mean[1..]) {
                    residual += (*mean - reference) * *a;
                }
                let residual = residual * count;
                for i in 0..n {
                    score[i] -= (mean[i + 1] - reference) * residual;
                }
                score.push(residual);
            }
        }
    }
}

/// [`LaneControl::first_order`] on its way.
struct FirstOrder<'a> {
    control: &'a LaneControl,
    parts: &'a [&'a LaneStatistics],
    step_mean: Option<Lane>,
    score: &'a mut Vec<Lane>,
    first_order: &'a mut Vec<Lane>,
}

impl Work for FirstOrder<'_> {
    #[inline(always)]
    fn run(self) {
        let Self { control, parts, step_mean, score, first_order } = self;
        control.score(parts, score);
        let per_sample = 1.0 / parts[0].counts.iter().sum::<f64>();
        let step = match step_mean {
            Some(mean) => mean - Lane::splat(control.step_mean),
            None => Lane::ZERO,
        };
        first_order.clear();
        for (row, slope) in control.map.chunks_exact(score.len()).zip(&control.step_slopes) {
            let mut sum = Lane::ZERO;
            for (weight, score) in row.iter().zip(score.iter()) {
                sum += *score * *weight;
            }
            first_order.push(sum * per_sample + step * *slope);
        }
    }
}
