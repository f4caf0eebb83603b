//! What the noise of an autoregression remembers.

use super::{SumVariance, autocovariance, filter, settling_samples};

/// What is left of the impulse response when it is taken as zero.
const FORGOTTEN: f64 = 1e-17;

/// The stationary noise `e = w/A`, `w` unit white noise: impulse response `h(k)`, autocovariances `γ(k)` and the variance of its mean, as far
/// back as double precision remembers.
///
/// ```
/// # use switchback_model::linear::NoiseMemory;
/// let noise = NoiseMemory::of(&[-0.5]);
/// assert!((noise.impulse(3) - 0.125).abs() < 1e-15);
/// assert!((noise.covariance(1) - 2.0 / 3.0).abs() < 1e-15);
/// assert_eq!(noise.impulse(noise.length() + 1), 0.0);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct NoiseMemory {
    impulse: Vec<f64>,
    gamma: Vec<f64>,
    sums: SumVariance,
}

impl NoiseMemory {
    /// For `A = 1 + a₁q⁻¹ + …`; `ar` holds `a₁…`.
    ///
    /// # Panics
    /// If `A` is unstable.
    pub fn of(ar: &[f64]) -> Self {
        let length = settling_samples(ar, FORGOTTEN) + ar.len();
        let mut kick = vec![0.0; length + 1];
        kick[0] = 1.0;
        Self {
            impulse: filter(ar, &[], &kick, &kick, 0.0, 0.0),
            gamma: autocovariance(ar, &[], length),
            sums: SumVariance::new(ar, &[], usize::MAX),
        }
    }

    /// The last lag at which anything is remembered.
    pub fn length(&self) -> usize {
        self.impulse.len() - 1
    }

    /// `h(k)`.
    pub fn impulse(&self, lag: usize) -> f64 {
        self.impulse.get(lag).copied().unwrap_or(0.0)
    }

    /// `γ(k)`.
    pub fn covariance(&self, lag: usize) -> f64 {
        self.gamma.get(lag).copied().unwrap_or(0.0)
    }

    /// Variance of the mean of `samples` values of the noise.
    pub fn mean_variance(&self, samples: usize) -> f64 {
        self.sums.at(samples) / (samples as f64 * samples as f64)
    }
}
