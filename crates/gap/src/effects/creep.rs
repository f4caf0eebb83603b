//! A slow after-effect of the operator's output.
//!
//! ```text
//! ũ = u + κ·(1−p)/(1−p q⁻¹) u,  p = exp(−1/τ)        first-order creep
//! u = C(v) + c·branch·ln(1 + rest/τ)                 logarithmic creep at rest
//! ```
//!
//! Parameters: `kappa` (−0.9…3), time constant `tau` in samples (8…5000). Stage: operator. After each move the output goes on
//! drifting the same way. Confused with: rate dependence, an extra pole (much faster), sensor drift.

use super::{Scene, Variant, fitted_tracks, own};
use crate::assembly::{BorderColumn, EquationColumn};

pub(super) fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    let tracks = fitted_tracks(scene.campaign);
    let starts = [(0.1, 15.0), (0.1, 80.0), (0.1, 500.0), (0.6, 40.0), (0.6, 200.0)]
        .iter()
        .map(|&(kappa, tau): &(f64, f64)| {
            vec![
                own("kappa", "1", kappa, (-0.9, 3.0), 0.002),
                own("log_tau", "ln samples", tau.ln(), (2.0, 8.5), 0.02),
            ]
        })
        .collect();
    let linear = Variant::conditional(starts, move |p, assembly| {
        let pole = (-(-p[1]).exp()).exp();
        assembly.filter(&[1.0 + p[0] * (1.0 - pole), -pole], &[1.0, -pole]);
        // How far the creep had gone when a record began is unknown.
        for &track in &tracks {
            let decay = EquationColumn::Decay { track, radius: pole, frequency: 0.0, sine: false };
            assembly.equation_columns.push(decay);
        }
    });
    let starts = [3.0, 30.0]
        .iter()
        .map(|&tau: &f64| vec![own("log_tau", "ln samples", tau.ln(), (-1.0, 7.0), 0.02)])
        .collect();
    let logarithmic = Variant::conditional(starts, |p, assembly| {
        assembly.border_columns.push(BorderColumn::RestingLog { scale: p[0].exp() });
    });
    vec![linear, logarithmic]
}
