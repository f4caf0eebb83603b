//! A lightly damped mode.
//!
//! ```text
//! ũ = (1 + n₁q⁻¹ + n₂q⁻²)/(1 − 2ρ cos ω q⁻¹ + ρ² q⁻²) u
//! ```
//!
//! Parameters: angular frequency `omega` (radians per sample), pole radius `rho` (0.5…0.995), numerator `n₁, n₂`. Stage: dynamics.
//! Ringing after every move. Confused with: extra pole, input delay. The equation error passes the mode or does not.

use super::{Variant, own};

pub(super) fn variants() -> Vec<Variant> {
    [false, true]
        .into_iter()
        .map(|passes| {
            let starts = [0.25, 0.6, 1.0, 1.5, 2.2]
                .iter()
                .map(|&omega: &f64| {
                    let rho: f64 = 0.9;
                    vec![
                        own("omega", "radians per sample", omega, (0.03, 3.1), 0.003),
                        own("rho", "1", rho, (0.5, 0.995), 0.002),
                        own("n1", "1", -2.0 * rho * omega.cos(), (-2.2, 2.2), 0.002),
                        own("n2", "1", rho * rho, (-1.2, 1.2), 0.002),
                    ]
                })
                .collect();
            Variant::new(starts, move |p, assembly| {
                let poles = [1.0, -2.0 * p[1] * p[0].cos(), p[1] * p[1]];
                assembly.filter(&[1.0, p[2], p[3]], &poles);
                if passes {
                    assembly.noise.ar = crate::assembly::times_monic(&assembly.noise.ar, &poles[1..]);
                }
            })
        })
        .collect()
}
