//! The quantile of 95 % intervals.

use statrs::distribution::{ContinuousCDF, Normal};
use std::sync::OnceLock;

/// `Φ⁻¹(0.975)`, the half width of a 95 % interval in standard errors.
pub fn normal_quantile_975() -> f64 {
    static VALUE: OnceLock<f64> = OnceLock::new();
    *VALUE.get_or_init(|| Normal::standard().inverse_cdf(0.975))
}
