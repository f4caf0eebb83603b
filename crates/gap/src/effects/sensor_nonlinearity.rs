//! The sensor's characteristic is curved.
//!
//! ```text
//! x = y + θ₂y² + θ₃y³ (+ θ₄y⁴),  likelihood with its Jacobian Σ ln dx/dy
//! ```
//!
//! Parameters: coefficients of the inverse characteristic, output in standard deviations about its mean. Stage: sensor.
//! The dynamics seem to depend on the level of y. Confused with: sensor saturation.

use super::{Variant, own};

pub(super) fn variants() -> Vec<Variant> {
    [1, 2, 3]
        .into_iter()
        .map(|count| {
            let names = ["theta2", "theta3", "theta4"];
            let start = (0..count)
                .map(|k| own(names[k], "per standard deviation of y", 0.0, (-0.6, 0.6), 0.0005))
                .collect();
            Variant::new(vec![start], |p, assembly| assembly.curve.powers = p.to_vec())
        })
        .collect()
}
