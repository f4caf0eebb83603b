//! A slow change whose path is free.

use super::Task;
use crate::attribution::explain::{EffectTerm, Hypothesis, assembled};
use crate::likelihood::engine::FitContext;
use crate::records::dataset::Dataset;

/// Gauss–Newton rounds.
const ROUNDS: usize = 8;
/// The number of the law: none of those that are searched from the beginning.
const NUMBER: usize = usize::MAX;

/// An effect alone whose law is followed by one with a drift path of its own in every record, from where the law with a clock ended.
pub(crate) fn on_a_free_drift_path(dataset: &Dataset, single: &Hypothesis) -> Option<Hypothesis> {
    let [EffectTerm { effect, .. }] = single.effect_terms[..] else { return None };
    let law = (effect.card().freed)(dataset, &single.fit)?;
    let effect_terms = vec![EffectTerm::of(effect, (NUMBER, &law))];
    let build = |values: &[f64]| assembled(&effect_terms, values);
    let context = FitContext { dataset, grid: &single.fit.grid, known: Some(single.fit.near()) };
    let task = Task { context, build: &build, fixed: 0 };
    let fit = task.together(&law.starts[0], &single.fit.linear, ROUNDS)?;
    Some(Hypothesis { effect_terms: effect_terms.clone(), fit, ..single.clone() })
        .filter(Hypothesis::is_sound)
}
