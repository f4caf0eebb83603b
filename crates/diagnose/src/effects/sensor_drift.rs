//! The sensor's zero moves.
//!
//! ```text
//! y = x + drift(t);  a slow drift enters the equation as A(1)·drift
//! ```
//!
//! Laws: a line or cubic over the dataset, a line that goes on in the pauses between records, a line over each record (common slope), piecewise linear within each
//! record, in long pieces or in short ones. Stage: sensor. The residual has a trend that no input explains. Confused with: gain drift, creep,
//! and a zero of its own in every record.

use super::{Card, Scene, Variant};
use crate::effect::{Effect, Stage};
use crate::model::augmented::{Clock, EquationColumn};

pub(super) const CARD: Card = Card {
    confounded_effects: &[Effect::RecordOffset],
    of_its_record: true,
    dominates_dynamics: true,
    ..Card::of(Stage::Sensor, variants)
};

fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    let mut out = Vec::new();
    for clock in [Clock::Dataset, Clock::Record] {
        for degrees in [1, 3] {
            out.push(Variant::new(vec![Vec::new()], move |_, augmented| {
                for degree in 1..=degrees {
                    augmented.equation_columns.push(EquationColumn::Trend { clock, degree });
                }
            }));
        }
    }
    out.push(Variant::new(vec![Vec::new()], |_, augmented| {
        let trend = |clock| EquationColumn::Trend { clock, degree: 1 };
        augmented.equation_columns.extend([Clock::Dataset, Clock::Pauses].map(trend));
    }));
    out.extend(PIECES.map(|pieces| piecewise(scene, pieces)));
    out
}

/// Samples of a piece, and pieces of a record at most.
const PIECES: [(usize, usize); 2] = [(400, 8), (160, 16)];

fn piecewise(scene: &Scene<'_>, (samples, most): (usize, usize)) -> Variant {
    let fitted =
        scene.dataset.scaled_records.iter().enumerate().filter(|(_, t)| t.is_fit() && t.v.len() > samples);
    let scaled_records: Vec<(usize, usize)> =
        fitted.map(|(number, t)| (number, (t.v.len() / samples).clamp(1, most))).collect();
    Variant::new(vec![Vec::new()], move |_, augmented| {
        for &(scaled, pieces) in &scaled_records {
            for piece in 0..=pieces {
                augmented.equation_columns.push(EquationColumn::Local { scaled, piece, pieces });
            }
        }
    })
}
