//! A sinusoid of unknown frequency.
//!
//! ```text
//! A y = B u + Σ (α cos ωt + β sin ωt),   amplitude and phase free a record, or one for the campaign;
//!                                      or the first three harmonics of one wave
//! ```
//!
//! Parameter: angular frequency `omega`, radians per sample. Stage: disturbance. One line in the residual spectrum of every record. Confused
//! with: resonance where the drive excites it, drift where it is slow.

use super::{Scene, Variant, fitted_tracks, own};
use crate::assembly::EquationColumn;
use crate::spectrum::strongest_lines;

pub(super) fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    let lines = strongest_lines(scene.innovations, 3);
    let longest = scene.innovations.iter().map(Vec::len).max().unwrap_or(1) as f64;
    // Fewer than eight periods a record are a drift.
    let slowest = 16.0 * std::f64::consts::PI / longest;
    let tracks = fitted_tracks(scene.campaign);
    let start = |omega: f64| vec![own("omega", "radians per sample", omega, (slowest, 3.13), 0.05 / longest)];
    let starts: Vec<_> = lines.iter().filter(|omega| **omega > slowest).map(|&omega| start(omega)).collect();
    if starts.is_empty() {
        return Vec::new();
    }
    let a_record = Variant::new(starts.clone(), move |p, assembly| {
        for &track in &tracks {
            for sine in [false, true] {
                let track = Some(track);
                assembly.equation_columns.push(EquationColumn::Line { frequency: p[0], track, sine });
            }
        }
    });
    let harmonics = Variant::new(starts.clone(), |p, assembly| {
        for harmonic in [1.0, 2.0, 3.0] {
            for sine in [false, true] {
                let frequency = harmonic * p[0];
                assembly.equation_columns.push(EquationColumn::Line { frequency, track: None, sine });
            }
        }
    });
    let campaign = Variant::new(starts, |p, assembly| {
        for sine in [false, true] {
            assembly.equation_columns.push(EquationColumn::Line { frequency: p[0], track: None, sine });
        }
    });
    vec![a_record, campaign, harmonics]
}
