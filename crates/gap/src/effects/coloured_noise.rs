//! The equation error is not white.
//!
//! ```text
//! ξ = w / D(q⁻¹), D of degree 1, 2 or 4;   or ξ = (1 + c q⁻¹) w
//! ```
//!
//! Parameters: coefficients of `D`, or `c`. Stage: disturbance. It moves no simulation error but biases least-squares estimates of `A`.
//! Confused with: output noise.

use super::{Variant, own};

pub(super) fn variants() -> Vec<Variant> {
    let mut out: Vec<Variant> = [1, 2, 4]
        .into_iter()
        .map(|degree| {
            let start = (0..degree).map(|_| own("d", "1", 0.0, (-2.5, 2.5), 0.003)).collect();
            Variant::new(vec![start], |p, assembly| {
                assembly.noise.ar = crate::assembly::times_monic(&assembly.noise.ar, p);
            })
        })
        .collect();
    let starts = [-0.3, 0.3].iter().map(|&c| vec![own("c", "1", c, (-0.97, 0.97), 0.003)]).collect();
    out.push(Variant::new(starts, |p, assembly| assembly.noise.ma = vec![p[0]]));
    out
}
