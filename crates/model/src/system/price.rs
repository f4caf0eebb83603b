//! The gain that parameters must have to be taken.

use super::LAWS;

/// The gain in `Σρ` that parameters must have to be taken: the extended BIC with `γ = 1`, of so many laws.
///
/// J. Chen, Z. Chen, Biometrika 95 (2008), doi 10.1093/biomet/asn034.
pub fn price(samples: usize, parameters: usize) -> f64 {
    parameters as f64 * ((samples.max(2) as f64).ln() + 2.0 * (LAWS.len() as f64).ln())
}
