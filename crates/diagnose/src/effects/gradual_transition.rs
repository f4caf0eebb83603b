//! The working point needs travel to pass from one border to the other.
//!
//! ```text
//! φ(x) = exp(−(x/length)^shape),  x the travel since the reversal
//! u = C(v) + φ·(u_rev − C(v_rev))      the distance to the border fades
//! u = (1−φ)·C(v) + φ·u_rev             the value at the reversal fades
//! u = (1−w)·C(v) + w·C_old(v), w = φ·w_rev   the other border fades, of which a reversal makes the own one: w_rev ← 1 − w
//! ```
//!
//! Parameters: `length` in strokes (0.002…1), `shape` (0.4…3.5; steeper envelopes are a rest that ends in a jump, which is play). Stage: operator. It rounds the loop after every reversal,
//! the more the smaller the loop; borders on large loops are untouched. Pulse experiments hardly see it. Confused
//! with: backlash. Laws of Dahl, Bouc–Wen and Coleman–Hodgdon kind are near the exponential envelope.

use super::{Card, Scene, Variant, fitted_scaled_records, parameter};
use crate::effect::{Effect, Stage};
use crate::model::augmented::{BorderColumn, Transition, TransitionLaw};

pub(super) const CARD: Card =
    Card { confounded_effects: &[Effect::Backlash], ..Card::of(Stage::Operator, variants) };

fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    [TransitionLaw::Offset, TransitionLaw::Held, TransitionLaw::Crossing]
        .into_iter()
        .map(|law| {
            let starts = [(0.012, 1.0), (0.04, 1.0), (0.12, 1.0), (0.12, 2.5), (0.35, 1.0)]
                .iter()
                .map(|&(length, shape)| {
                    vec![
                        parameter("length", "strokes", length, (0.002, 1.0), 0.02 * length),
                        parameter("shape", "1", shape, (0.4, 3.5), 0.02),
                    ]
                })
                .collect();
            // A working point that remembers was somewhere when the record began; the first pulse makes it forget.
            let mut scaled_records = fitted_scaled_records(scene.dataset);
            if !scene.dataset.criterion.simulates() {
                scaled_records.retain(|scaled| !scene.dataset.scaled_records[*scaled].is_pulsed());
            }
            Variant::conditional(starts, move |p, augmented| {
                augmented.transition = Some(Transition { length: p[0], shape: p[1], law });
                let columns = scaled_records.iter().map(|&scaled| BorderColumn::Start { scaled });
                augmented.border_columns.extend(columns);
            })
        })
        .collect()
}
