//! A lag that the order of the model has no room for.
//!
//! ```text
//! ũ = (1−p)/(1−p q⁻¹) u            an actuator: the equation error does not pass it
//! (1−p q⁻¹) A y = B u + ξ          a lag of the plant: the equation error passes it
//! ũ = (c + d q⁻¹)/(1−p q⁻¹) u      a lag that lets part of its input through
//! ũ = (1−p)²/(1−p q⁻¹)² u          two equal lags
//! ```
//!
//! Parameter: `pole` (0.004…0.98; with feedthrough from 0.15, below which it is a delay). Stage: dynamics. Confused with: input delay, resonance.

use super::{Scene, Variant, fitted_tracks, own};
use crate::assembly::EquationColumn;
use crate::engine::Fit;

pub(super) fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    [(1, false, 0), (1, true, 0), (1, false, 1), (2, false, 0)]
        .into_iter()
        .map(|(lags, passes, zeros)| {
            // What bypasses a lag lets the lag be slow.
            let (least, starts): (f64, &[f64]) = if zeros > 0 {
                (0.15, &[0.3, 0.5, 0.7, 0.85, 0.93, 0.97])
            } else {
                (0.004, &[0.03, 0.2, 0.5, 0.8])
            };
            let starts = starts.iter().map(|&p| vec![own("pole", "1", p, (least, 0.98), 0.003)]).collect();
            // How far a slow lag was behind when a record began is unknown.
            let tracks = if zeros > 0 { fitted_tracks(scene.campaign) } else { Vec::new() };
            Variant::conditional(starts, move |p, assembly| {
                for _ in 0..lags {
                    assembly.filter(&[1.0 - p[0]], &[1.0, -p[0]]);
                }
                assembly.extra_b += zeros;
                for &track in &tracks {
                    let decay = EquationColumn::Decay { track, radius: p[0], frequency: 0.0, sine: false };
                    assembly.equation_columns.push(decay);
                }
                if passes {
                    assembly.noise.ar = crate::assembly::times_monic(&assembly.noise.ar, &[-p[0]]);
                }
            })
        })
        .collect()
}

/// Least magnitude of the fastest pole of `A`.
const GONE: f64 = 0.03;

/// A pole in series is no extra one where `A` has given up one of its own: the plant's noise then is that of its output.
pub(super) fn is_sound(fit: &Fit) -> bool {
    let in_series = fit.assembly.denominator.len() > 1;
    let a = &fit.linear.a;
    let before_last = if a.len() > 1 { a[a.len() - 2].abs() } else { 1.0 };
    // Vieta: far poles apart, the last two coefficients have the ratio of the fastest.
    !in_series || a.last().is_none_or(|last| last.abs() > GONE * before_last)
}
