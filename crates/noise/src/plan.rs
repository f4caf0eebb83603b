//! What a pass over the noise must record.

use switchback_model::linear::is_stable;
use thiserror::Error;

/// Why a [`NoisePlan`] cannot be run.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum NoisePlanError {
    /// A filter coefficient is not a number.
    #[error("the {polynomial} coefficient {index} of the noise filter is {value}; give a finite number")]
    NotFinite {
        /// `ar` or `ma`.
        polynomial: &'static str,
        /// Counted from one, as in the polynomial.
        index: usize,
        /// What was given.
        value: f64,
    },
    /// The filter has no stationary output.
    #[error("1/A is not stable: a root of A has modulus 1 or more; move the poles inside the unit circle")]
    Unstable,
    /// Nothing to record.
    #[error("no checkpoint is given; name at least one number of samples")]
    NoCheckpoint,
    /// A checkpoint of no samples, or one not after its predecessor.
    #[error("checkpoint {value} follows {previous}; checkpoints start at 1 or more and increase strictly")]
    CheckpointOrder {
        /// The checkpoint before it, or 0.
        previous: usize,
        /// The offending one.
        value: usize,
    },
    /// A period of no samples.
    #[error("period {index} of the folds is 0 samples; a period is at least 1")]
    ZeroPeriod {
        /// Position in the list, from zero.
        index: usize,
    },
}

/// What a pass over the noise must record: of which filter, over which lags, periods and numbers of samples.
///
/// ```text
/// A(q⁻¹) e(t) = C(q⁻¹) w(t),   A = 1 + a₁q⁻¹ + …,   C = 1 + c₁q⁻¹ + …,   w unit white normal
/// ```
///
/// The filter starts at rest (w = e = 0) at `t = −burn_in`, so that `e` is stationary at `t = 0` to within
/// what is left of the impulse response of C/A after `burn_in` samples; [`settling_samples`](switchback_model::linear::settling_samples) gives a number
/// after which nothing is left in double precision.
#[derive(Clone, Debug, PartialEq)]
pub struct NoisePlan {
    /// `a₁…a_p`; empty for white noise or a pure moving average.
    pub ar: Vec<f64>,
    /// `c₁…c_q`; empty for the equation error of the standard model.
    pub ma: Vec<f64>,
    /// The greatest lag n of the lag products.
    pub lags: usize,
    /// Periods T of the folds, in samples; the records hold the folds in this order.
    pub periods: Vec<usize>,
    /// Numbers of samples N at which to record, increasing.
    pub checkpoints: Vec<usize>,
    /// Samples run before `t = 0`.
    pub burn_in: usize,
}

impl NoisePlan {
    /// Checks that the plan can be run.
    ///
    /// # Errors
    /// See [`NoisePlanError`].
    pub(crate) fn validate(&self) -> Result<(), NoisePlanError> {
        for (polynomial, coefficients) in [("ar", &self.ar), ("ma", &self.ma)] {
            if let Some(i) = coefficients.iter().position(|x| !x.is_finite()) {
                return Err(NoisePlanError::NotFinite { polynomial, index: i + 1, value: coefficients[i] });
            }
        }
        if !is_stable(&self.ar) {
            return Err(NoisePlanError::Unstable);
        }
        if self.checkpoints.is_empty() {
            return Err(NoisePlanError::NoCheckpoint);
        }
        let mut previous = 0;
        for &value in &self.checkpoints {
            if value <= previous {
                return Err(NoisePlanError::CheckpointOrder { previous, value });
            }
            previous = value;
        }
        match self.periods.iter().position(|&period| period == 0) {
            Some(index) => Err(NoisePlanError::ZeroPeriod { index }),
            None => Ok(()),
        }
    }

    /// Samples of `e` and `w` that the next block needs from the one before.
    pub(super) fn history(&self) -> usize {
        self.ar.len().max(self.lags)
    }
}
