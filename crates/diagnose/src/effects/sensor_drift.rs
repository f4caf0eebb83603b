//! The sensor's zero moves.
//!
//! ```text
//! y = x + drift(t);  a slow drift enters the equation as A(1)·drift
//! ```
//!
//! Laws: a line or cubic over the campaign, a line that goes on in the pauses between records, a line over each record (common slope), piecewise linear within each
//! record, in long pieces or in short ones. Stage: sensor. The residual has a trend that no input explains. Confused with: gain drift, creep,
//! and a zero of its own in every record.

use super::{Card, Scene, Variant};
use crate::effect::{Effect, Stage};
use crate::model::assembly::{Clock, EquationColumn};

pub(super) const CARD: Card = Card {
    twins: &[Effect::RecordOffset],
    of_its_record: true,
    supple: true,
    dominates_dynamics: true,
    ..Card::of(Stage::Sensor, variants)
};

fn variants(scene: &Scene<'_>) -> Vec<Variant> {
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
    out.push(Variant::new(vec![Vec::new()], |_, assembly| {
        let trend = |clock| EquationColumn::Trend { clock, degree: 1 };
        assembly.equation_columns.extend([Clock::Campaign, Clock::Pauses].map(trend));
    }));
    out.extend(PIECES.map(|pieces| piecewise(scene, pieces)));
    out
}

/// Samples of a piece, and pieces of a record at most.
const PIECES: [(usize, usize); 2] = [(400, 8), (160, 16)];

fn piecewise(scene: &Scene<'_>, (samples, most): (usize, usize)) -> Variant {
    let fitted = scene.campaign.tracks.iter().enumerate().filter(|(_, t)| t.is_fit() && t.v.len() > samples);
    let tracks: Vec<(usize, usize)> =
        fitted.map(|(number, t)| (number, (t.v.len() / samples).clamp(1, most))).collect();
    Variant::new(vec![Vec::new()], move |_, assembly| {
        for &(track, pieces) in &tracks {
            for piece in 0..=pieces {
                assembly.equation_columns.push(EquationColumn::Local { track, piece, pieces });
            }
        }
    })
}
