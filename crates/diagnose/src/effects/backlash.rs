//! Play between the recorded input and the operator.
//!
//! ```text
//! p(t) = p(t−1) unless |v − p| exceeds half the play; u = F[p];   the play even, or changing along the stroke
//! ```
//!
//! Parameters: full width `play`, in strokes (0.00001…0.7), its relative change `taper` from the middle of the stroke to its upper end
//! (−1…1: wear is uneven). Stage: operator. It leaves a rest of `u` after each reversal, for a
//! travel equal to the play; the shift `v ∓ play/2` along the branches is absorbed by the borders, so designed
//! pulse experiments alone do not see it. Confused with: gradual transition (the jump at the end of the rest shows),
//! a reversal threshold against noise on `v`.

use super::{Card, Scene, Search, Variant, parameter};
use crate::effect::{Effect, Stage};
use crate::records::dataset::Dataset;
use crate::records::motion::Play;

pub(super) const CARD: Card =
    Card { confounded_effects: &[Effect::GradualTransition], ..Card::of(Stage::Operator, variants) };

/// Starts are this width times powers of a ratio, in strokes.
const ANCHOR: f64 = 0.0006;
/// No play is narrower, in strokes.
const NARROWEST: f64 = 1e-5;
/// Samples that must lie within a play of the last reversal for it to leave a trace.
const TRACES: usize = 3;

/// The width below which a play leaves no trace in the fit records, [`ANCHOR`] at most.
fn narrowest(dataset: &Dataset) -> f64 {
    let moves = dataset.fit().flat_map(|t| t.moves.iter()).filter(|m| m.moves && m.travel > 0.0);
    let mut travels: Vec<f64> = moves.map(|m| m.travel).filter(|travel| *travel < ANCHOR).collect();
    travels.sort_by(f64::total_cmp);
    travels.get(TRACES - 1).copied().unwrap_or(ANCHOR).max(2.0 * NARROWEST)
}

fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    // The profile is not smooth: a width off by half has lost the trace.
    let least = narrowest(scene.dataset);
    let widths = |ratio: f64| {
        let below = (ANCHOR / least).log(ratio).floor() as i32;
        let first = ANCHOR * ratio.powi(-below);
        std::iter::successors(Some(first), move |w| Some(ratio * w)).take_while(|w| *w < 0.6)
    };
    let width = |w: f64| parameter("play", "strokes", w, (0.5 * least, 0.7), 0.16 * w);
    let even = widths(1.5).map(|w| vec![width(w)]).collect();
    let tapered =
        |w: f64| [-0.6, 0.6].map(|taper| vec![width(w), parameter("taper", "1", taper, (-1.0, 1.0), 0.3)]);
    let tapered = widths(1.7).flat_map(tapered).collect();
    [
        Variant::new(even, |p, augmented| augmented.play = Play { width: p[0], taper: 0.0 }),
        Variant::new(tapered, |p, augmented| augmented.play = Play { width: p[0], taper: p[1] }),
    ]
    .map(|law| Variant { search: Search::Profile, ..law })
    .into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::records::motion::motions;
    use crate::testing::small_dataset;

    #[test]
    fn plays_are_searched_as_narrow_as_the_records_show_them() {
        let (mut dataset, _) = small_dataset();
        assert!((narrowest(&dataset) - ANCHOR).abs() < 1e-15);
        // Three reversals, each followed by a move of 0.0002 strokes before the next larger one.
        let v: Vec<f64> = [0.1, 0.5, 0.4998, 0.3, 0.3002, 0.6, 0.5998, 0.2].into();
        dataset.scaled_records[0].moves = motions(&v, Play::default(), dataset.rule).into();
        assert!((narrowest(&dataset) - 0.0002).abs() < 1e-9);
    }
}
