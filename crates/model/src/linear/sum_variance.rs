//! The variance of a sum of stationary noise.

use super::{autocovariance, settling_samples};

/// What is left of the noise's memory when its covariance is taken as zero.
const FORGOTTEN: f64 = 1e-17;

/// Variance of `S_N = e(0) + … + e(N−1)`, `e = C/A w` stationary, `w` unit white noise:
///
/// ```text
/// V(N) = N γ(0) + 2 Σ_{k=1}^{N−1} (N−k) γ(k)          γ the autocovariances of e
/// ```
///
/// Exact for every `N`, by sums over the lags at which the noise remembers anything.
///
/// ```
/// # use switchback_model::linear::SumVariance;
/// let variance = SumVariance::new(&[-0.5], &[], 1000);
/// // γ(0) = 4/3 and γ(1) = 2/3.
/// assert!((variance.at(2) - 2.0 * (4.0 / 3.0 + 2.0 / 3.0)).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct SumVariance {
    /// `γ(0)`.
    variance: f64,
    /// `Σ_{k=1}^{K} γ(k)` and `Σ_{k=1}^{K} k γ(k)`, for `K = 0, 1, …`.
    sums: Vec<[f64; 2]>,
}

impl SumVariance {
    /// For sums of no more than `longest` values; `ar` and `ma` hold `a₁…` and `c₁…`.
    pub fn new(ar: &[f64], ma: &[f64], longest: usize) -> Self {
        let lags = (settling_samples(ar, FORGOTTEN) + ma.len()).min(longest);
        let gamma = autocovariance(ar, ma, lags);
        let mut sums = vec![[0.0; 2]];
        let mut sum = [0.0; 2];
        for (k, gamma) in gamma.iter().enumerate().skip(1) {
            sum = [sum[0] + gamma, sum[1] + k as f64 * gamma];
            sums.push(sum);
        }
        Self { variance: gamma[0], sums }
    }

    /// `V(N)`.
    pub fn at(&self, samples: usize) -> f64 {
        let n = samples as f64;
        let [plain, weighted] = self.sums[samples.saturating_sub(1).min(self.sums.len() - 1)];
        n * self.variance + 2.0 * (n * plain - weighted)
    }
}
