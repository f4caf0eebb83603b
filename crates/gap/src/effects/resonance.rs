//! A lightly damped mode.
//!
//! ```text
//! A y = B⁺/(1 − 2ρ cos ω q⁻¹ + ρ² q⁻²) u + ξ,   B⁺ with two more coefficients than B
//! ```
//!
//! Parameters: angular frequency `omega` (radians per sample), pole radius `rho` (0.6…0.995). Stage: dynamics.
//! Ringing after every move. Confused with: extra pole, input delay. The equation error passes the mode or does not.

use super::{Scene, Variant, fitted_tracks, own};
use crate::assembly::EquationColumn;
use crate::spectrum::strongest_lines;

pub(super) fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    // A mode rings in the residual: its lines are the likeliest frequencies.
    let mut omegas = strongest_lines(scene.innovations, 2);
    omegas.retain(|w| *w > 0.1);
    omegas.extend([0.35, 0.75, 1.2, 1.8]);
    [false, true]
        .into_iter()
        .map(|passes| {
            let tracks = fitted_tracks(scene.campaign);
            let starts = omegas
                .iter()
                .map(|&omega| {
                    vec![
                        own("omega", "radians per sample", omega, (0.03, 3.1), 0.003),
                        own("rho", "1", 0.91, (0.6, 0.995), 0.002),
                    ]
                })
                .collect();
            Variant::conditional(starts, move |p, assembly| {
                let poles = [1.0, -2.0 * p[1] * p[0].cos(), p[1] * p[1]];
                assembly.filter(&[1.0], &poles);
                assembly.extra_b += 2;
                // The mode rings when a record begins, nobody knows how.
                for &track in &tracks {
                    for sine in [false, true] {
                        let (radius, frequency) = (p[1], p[0]);
                        assembly.equation_columns.push(EquationColumn::Decay {
                            track,
                            radius,
                            frequency,
                            sine,
                        });
                    }
                }
                if passes {
                    assembly.noise.ar = crate::assembly::times_monic(&assembly.noise.ar, &poles[1..]);
                }
            })
        })
        .collect()
}
