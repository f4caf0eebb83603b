//! Control variates for any estimator: sums of the noise whose means and covariances are known exactly.
//!
//! Whatever an estimator computes from the records of a periodic experiment is, to first order in the noise `w`, a weighted sum of it with
//! weights that repeat, and of products of the noise with its past:
//!
//! ```text
//! l_p = Σ_{t ≡ p (mod T)} w(t)              mean 0, variance the number of such t
//! q_i = Σ_t w(t) e(t−i),  e = C/A w         mean 0, covariance N γ(i−j), γ the autocovariance of e; none with any l_p
//! ```
//!
//! The score of the efficient estimate is made of these sums alone. Where the noise changes its sign, so do the `l_p`, and the `q_i` do not.

use super::control_sums::ControlShape;
use switchback_model::linear::autocovariance;
use switchback_noise::{NoisePlan, NoiseSamples};

/// More linear controls than this cost more memory and time than they save; antithetic partners do without.
const MOST_LINEAR: usize = 160;

/// What the controls of a cell are.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ControlPlan {
    /// `T`
    period: usize,
    /// `N`
    samples: usize,
    /// `n`
    order: usize,
    /// Whether the linear ones are there.
    is_linear: bool,
}

impl ControlPlan {
    pub(super) fn new(period: usize, samples: usize, order: usize) -> Self {
        Self { period, samples, order, is_linear: 2 * period <= MOST_LINEAR }
    }

    /// What the sums of a cell hold of them.
    pub(super) fn shape(&self, parameters: usize, is_paired: bool) -> ControlShape {
        let linear = if self.is_linear { 2 * self.period } else { 0 };
        ControlShape { linear, quadratic: 2 * self.order, parameters, is_paired }
    }

    /// The controls of one replicate: linear ones by experiment and phase, quadratic ones by experiment and lag.
    pub(super) fn values(&self, noise: &[NoiseSamples; 2]) -> Vec<f64> {
        let linear = noise.iter().filter(|_| self.is_linear).flat_map(|noise| self.folds(noise));
        let quadratic = noise.iter().flat_map(|noise| (1..=self.order).map(|lag| self.product(noise, lag)));
        linear.chain(quadratic).collect()
    }

    fn folds(&self, noise: &NoiseSamples) -> Vec<f64> {
        let mut folds = vec![0.0; self.period];
        for period in noise.w[noise.burn_in..noise.burn_in + self.samples].chunks(self.period) {
            folds.iter_mut().zip(period).for_each(|(fold, w)| *fold += w);
        }
        folds
    }

    fn product(&self, noise: &NoiseSamples, lag: usize) -> f64 {
        let (first, end) = (noise.burn_in, noise.burn_in + self.samples);
        // Before the noise begins there is none.
        let from = first.max(lag);
        noise.w[from..end].iter().zip(&noise.e[from - lag..]).map(|(w, e)| w * e).sum()
    }

    /// The covariance of two controls.
    pub(super) fn covariance(&self, noise: &NoisePlan) -> impl Fn(usize, usize) -> f64 + use<> {
        let gamma = autocovariance(&noise.ar, &noise.ma, self.order);
        let Self { period, samples, order, is_linear } = *self;
        let (linear, burn_in) = (if is_linear { 2 * period } else { 0 }, noise.burn_in);
        move |i, j| match (i.checked_sub(linear), j.checked_sub(linear)) {
            (None, None) if i == j => ((samples + period - 1 - i % period) / period) as f64,
            (Some(i), Some(j)) if i / order == j / order => {
                let lags = [i % order + 1, j % order + 1];
                // Before the noise begins there is none to multiply with.
                let missing = lags[0].max(lags[1]).saturating_sub(burn_in);
                (samples - missing.min(samples)) as f64 * gamma[lags[0].abs_diff(lags[1])]
            }
            _ => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use switchback_noise::{StreamId, samples};

    fn noise_plan(ar: &[f64], burn_in: usize) -> NoisePlan {
        let (ar, ma) = (ar.to_vec(), Vec::new());
        NoisePlan { ar, ma, lags: 2, periods: Vec::new(), checkpoints: vec![50], burn_in }
    }

    #[test]
    fn controls_have_mean_zero_and_the_covariance_that_is_stated() {
        for (ar, burn_in) in [(vec![-0.7], 120), (Vec::new(), 0)] {
            let noise = noise_plan(&ar, burn_in);
            let plan = ControlPlan::new(7, 50, 2);
            let draws: Vec<Vec<f64>> = (0..6000)
                .map(|replicate| {
                    let of = |experiment| samples(&noise, StreamId { seed: 2, experiment, replicate }, 60);
                    plan.values(&[of(0).expect("a plan"), of(1).expect("a plan")])
                })
                .collect();
            let shape = plan.shape(1, true);
            assert_eq!((shape.linear, shape.quadratic, draws[0].len()), (14, 4, 18));
            let (covariance, count) = (plan.covariance(&noise), draws.len() as f64);
            for i in 0..18 {
                let sd = covariance(i, i).sqrt();
                let mean = draws.iter().map(|c| c[i]).sum::<f64>() / count;
                assert!(mean.abs() < 4.5 * sd / count.sqrt(), "{i}: {mean}");
                for j in 0..=i {
                    let found = draws.iter().map(|c| c[i] * c[j]).sum::<f64>() / count;
                    let scale = sd * covariance(j, j).sqrt();
                    let off = (found - covariance(i, j)) / scale;
                    assert!(off.abs() < 0.12, "{i}, {j}: {found} {}", covariance(i, j));
                }
            }
        }
    }

    #[test]
    fn long_periods_have_no_linear_controls() {
        assert_eq!(ControlPlan::new(MOST_LINEAR, 1000, 3).shape(2, false).linear, 0);
    }
}
