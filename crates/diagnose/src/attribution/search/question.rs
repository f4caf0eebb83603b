//! What a search asks.

use crate::attribution::explain::Hypothesis;
use crate::effect::Effect;
use crate::effects::Variant;
use crate::likelihood::engine::NonlinearParameter;

/// An effect whose laws may explain more, and what is known about it.
#[derive(Debug, Clone)]
pub(crate) struct Question {
    pub(crate) effect: Effect,
    /// The law that served it best alone, with the nonlinear parameters that it had; all laws from all their starts where none is
    /// given.
    pub(crate) alone: Option<(usize, Vec<NonlinearParameter>)>,
}

impl Question {
    /// Every law of an effect.
    pub(crate) fn open(effect: Effect) -> Self {
        Self { effect, alone: None }
    }

    /// The law of an effect that was fitted alone, from where it ended.
    pub(crate) fn after(single: &Hypothesis) -> Self {
        let effect_term = &single.effect_terms[0];
        let (effect, law) = effect_term.law;
        Self { effect, alone: Some((law, single.fit.nonlinear.clone())) }
    }

    /// The law, with fewer starts where something is known; none where another law is asked for.
    pub(super) fn narrowed(&self, number: usize, mut law: Variant) -> Option<Variant> {
        let Some((known, nonlinear)) = &self.alone else { return Some(law) };
        if *known != number {
            return None;
        }
        // Where the likelihood has corners what was found alone may be far off: all starts are needed.
        if !law.search.is_by_pattern() && nonlinear.len() == law.starts[0].len() {
            let middle = law.starts.swap_remove(law.starts.len() / 2);
            law.starts = vec![nonlinear.clone(), middle];
        }
        Some(law)
    }
}
