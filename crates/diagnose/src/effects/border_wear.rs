//! The loop between the borders narrows or widens as the rig works.
//!
//! ```text
//! u = (1 − w/2)·C(v) + (w/2)·C_other(v),   w = Σ cₖ sₖ(clock)         the loop narrows in proportion
//! u = C(v) + c·branch·clock                                          both borders move apart evenly
//! u = C(v) + c·clock on one border                                   one face wears
//! ```
//!
//! Parameters: coefficients of the slow change; clocks: samples of the dataset, samples of the record, travel of the dataset. Stage: operator.
//! Late records have other loops than early ones, with the mid-line untouched. Confused with: gain drift, a loop that steps.

use super::{Card, Scene, Variant, parameter};
use crate::effect::{Effect, Stage};
use crate::model::augmented::{BorderColumn, Clock, Slow};

pub(super) const CARD: Card = Card {
    confounded_effects: &[Effect::GainDrift, Effect::StepChange],
    of_its_record: true,
    dominates_dynamics: true,
    ..Card::of(Stage::Operator, variants)
};

fn variants(_: &Scene<'_>) -> Vec<Variant> {
    let mut out = Vec::new();
    for clock in [Clock::Dataset, Clock::Record, Clock::Travel] {
        for degree in [1, 2] {
            // Where the loop all but closes, the nominal model is that of another system.
            let starts = [0.0, 0.5, 1.0, -0.5].map(|end| {
                let value = |k| if k == 0 { end } else { 0.0 };
                (0..degree).map(|k| parameter("narrowing", "1", value(k), (-1.5, 1.5), 0.002)).collect()
            });
            out.push(Variant::new(starts.into(), move |p, augmented| {
                augmented.wear = Some(Slow { coefficients: p.to_vec(), ..Slow::on(clock) });
            }));
        }
        out.push(Variant::new(vec![Vec::new()], move |_, augmented| {
            augmented.border_columns.push(BorderColumn::BranchSlow { clock });
        }));
        for branch in [-1.0, 1.0] {
            out.push(Variant::new(vec![Vec::new()], move |_, augmented| {
                augmented.border_columns.push(BorderColumn::SideSlow { clock, branch });
            }));
        }
    }
    out
}
