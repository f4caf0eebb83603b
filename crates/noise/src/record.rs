//! What a pass over the noise records.

use nalgebra::DMatrix;

use super::plan::NoisePlan;

/// Sums over the first N samples of one replicate's noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// N.
    pub samples: usize,
    /// `Σ_{t=0}^{N−1} e(t−i) e(t−l)`, (n+1) × (n+1), symmetric.
    pub lag_products: DMatrix<f64>,
    /// For each period T of the plan the T sums `F_p = Σ e(t)` over `0 ≤ t < N` with `t ≡ p mod T`.
    pub folds: Vec<Vec<f64>>,
    /// `e(N−n) … e(N−1)`, oldest first.
    pub tail: Vec<f64>,
}

/// Everything that the estimators' sufficient statistics need of one replicate's noise.
#[derive(Clone, Debug, PartialEq)]
pub struct NoiseRecord {
    /// `e(−n) … e(−1)`, oldest first.
    pub head: Vec<f64>,
    /// One a checkpoint of the plan, in its order.
    pub checkpoints: Vec<Checkpoint>,
}

impl NoiseRecord {
    /// All zero, of the plan's shapes.
    pub(super) fn zeros(plan: &NoisePlan) -> Self {
        let n = plan.lags;
        let checkpoint = |&samples| Checkpoint {
            samples,
            lag_products: DMatrix::zeros(n + 1, n + 1),
            folds: plan.periods.iter().map(|&period| vec![0.0; period]).collect(),
            tail: vec![0.0; n],
        };
        Self { head: vec![0.0; n], checkpoints: plan.checkpoints.iter().map(checkpoint).collect() }
    }
}

impl Checkpoint {
    /// Fills the lag products from the autoproducts `R_k = Σ_{t=0}^{N−1} e(t) e(t−k)`, `k = 0…n`, by moving
    /// both ends of the sum:
    ///
    /// ```text
    /// Σ_{t=0}^{N−1} e(t−i) e(t−i−k) = R_k + Σ_{u=−i}^{−1} e(u) e(u−k) − Σ_{u=N−i}^{N−1} e(u) e(u−k)
    /// ```
    ///
    /// exact algebra; the terms lie within the edges because `i + k ≤ n`.
    pub(super) fn set_lag_products(&mut self, autoproducts: &[f64], head: &[f64]) {
        let n = self.tail.len();
        for k in 0..=n {
            let mut sum = autoproducts[k];
            for i in 0..=n - k {
                if i > 0 {
                    // e(−i) is head[n − i], e(N−i) is tail[n − i].
                    sum += head[n - i] * head[n - i - k] - self.tail[n - i] * self.tail[n - i - k];
                }
                self.lag_products[(i, i + k)] = sum;
                self.lag_products[(i + k, i)] = sum;
            }
        }
    }
}
