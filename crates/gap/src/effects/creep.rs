//! A slow after-effect of the operator's output.
//!
//! ```text
//! ũ = u + κ·(1−p)/(1−p q⁻¹) u,  p = exp(−1/τ)        first-order creep
//! u = C(v) + c·branch·ln(1 + rest/τ)                 logarithmic creep at rest
//! ```
//!
//! Parameters: `kappa` (−0.9…3), time constant `tau` in samples (8…5000). Stage: operator. After each move the output goes on
//! drifting the same way. Confused with: rate dependence, an extra pole (much faster), sensor drift.

use super::{Variant, own};
use crate::assembly::BorderColumn;

pub(super) fn variants() -> Vec<Variant> {
    let starts = [15.0, 50.0, 200.0, 800.0]
        .iter()
        .map(|&tau: &f64| {
            vec![
                own("kappa", "1", 0.1, (-0.9, 3.0), 0.002),
                own("log_tau", "ln samples", tau.ln(), (2.0, 8.5), 0.02),
            ]
        })
        .collect();
    let linear = Variant::new(starts, |p, assembly| {
        let pole = (-(-p[1]).exp()).exp();
        assembly.filter(&[1.0 + p[0] * (1.0 - pole), -pole], &[1.0, -pole]);
    });
    let starts = [3.0, 30.0]
        .iter()
        .map(|&tau: &f64| vec![own("log_tau", "ln samples", tau.ln(), (-1.0, 7.0), 0.02)])
        .collect();
    let logarithmic = Variant::new(starts, |p, assembly| {
        assembly.border_columns.push(BorderColumn::RestingLog { scale: p[0].exp() });
    });
    vec![linear, logarithmic]
}
