//! A slow change whose path is free.

use super::Task;
use crate::attribution::explain::{Explanation, Part, assembled};
use crate::likelihood::engine::Ground;
use crate::records::campaign::Campaign;

/// Gauss–Newton rounds.
const ROUNDS: usize = 8;
/// The number of the law: none of those that are searched from the beginning.
const NUMBER: usize = usize::MAX;

/// An effect alone whose law is followed by one with a drift path of its own in every record, from where the law with a clock ended.
pub(crate) fn on_a_free_drift_path(campaign: &Campaign, single: &Explanation) -> Option<Explanation> {
    let [Part { effect, .. }] = single.parts[..] else { return None };
    let law = (effect.card().freed)(campaign, &single.fit)?;
    let parts = vec![Part::of(effect, (NUMBER, &law))];
    let build = |values: &[f64]| assembled(&parts, values);
    let ground = Ground { campaign, grid: &single.fit.grid, known: Some(single.fit.near()) };
    let task = Task { ground, build: &build, held: 0 };
    let fit = task.together(&law.starts[0], &single.fit.linear, ROUNDS)?;
    Some(Explanation { parts: parts.clone(), fit, ..single.clone() }).filter(Explanation::is_sound)
}
