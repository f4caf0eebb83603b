//! The quantile of 95 % intervals.

use statrs::distribution::{ContinuousCDF, Normal};
use std::sync::OnceLock;

/// The half width of a 95 % interval in standard errors, to the nearest number: for whatever is no result of a study.
pub const Z95: f64 = 1.959_963_984_540_054;

/// The same as the results of studies have it: `Φ⁻¹(0.975)` by an algorithm, whose last bit is another.
pub fn normal_quantile_975() -> f64 {
    static VALUE: OnceLock<f64> = OnceLock::new();
    *VALUE.get_or_init(|| Normal::standard().inverse_cdf(0.975))
}
