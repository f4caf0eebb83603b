//! The sensor's zero moves.
//!
//! ```text
//! y = x + drift(t);  a slow drift enters the equation as A(1)·drift
//! ```
//!
//! Laws: a line or cubic over the campaign, a line over each record (common slope), piecewise linear within each
//! record. Stage: sensor. The residual has a trend that no input explains. Confused with: gain drift, creep.

use super::{Scene, Variant};
use crate::assembly::{Clock, EquationColumn};

pub(super) fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    let mut out = Vec::new();
    for clock in [Clock::Campaign, Clock::Record] {
        for degrees in [1, 3] {
            out.push(Variant::new(vec![Vec::new()], move |_, assembly| {
                for degree in 1..=degrees {
                    assembly.equation_columns.push(EquationColumn::Trend { clock, degree });
                }
            }));
        }
    }
    let tracks: Vec<(usize, usize)> = scene
        .campaign
        .tracks
        .iter()
        .enumerate()
        .filter(|(_, t)| t.is_fit() && t.v.len() > 400)
        .map(|(i, t)| (i, (t.v.len() / 400).clamp(1, 8)))
        .collect();
    out.push(Variant::new(vec![Vec::new()], move |_, assembly| {
        for &(track, pieces) in &tracks {
            for piece in 0..=pieces {
                assembly.equation_columns.push(EquationColumn::Local { track, piece, pieces });
            }
        }
    }));
    out
}
