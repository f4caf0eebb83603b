//! The input of `B`, its taps applied.

use crate::likelihood::design::{Design, DesignScaled};
use crate::model::linear::Linear;

/// `taps ∗ ũ`: what the coefficients of B multiply.
pub(super) fn tapped(design: &Design, scaled: &DesignScaled, p: &Linear) -> Vec<f64> {
    let u = design.input(scaled, &p.f);
    if design.taps.len() == 1 && design.taps[0] == 1.0 {
        return u;
    }
    (0..u.len())
        .map(|t| design.taps.iter().enumerate().map(|(k, c)| c * u[t.saturating_sub(k)]).sum())
        .collect()
}
