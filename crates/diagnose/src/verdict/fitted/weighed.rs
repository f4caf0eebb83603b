//! What the fitted verdict gives to every alternative.

use super::features::Alternatives;
use crate::effect::Effect;

/// Probabilities of the alternatives of a diagnosis.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Weighed {
    /// Of every effect with a fit, the likeliest first.
    pub(crate) effects: Vec<(Effect, f64)>,
    pub(crate) none: f64,
    pub(crate) none_of_these: f64,
    /// Whether evidence like this was met when the verdict was fitted.
    pub(crate) is_met: bool,
}

impl Weighed {
    /// From the probabilities of the effects, of nothing and of none of these, as if evidence like this was met.
    pub(super) fn new(alternatives: &Alternatives, p: &[f64]) -> Self {
        let (of_effects, rest) = p.split_at(alternatives.effects.len());
        let mut effects: Vec<(Effect, f64)> =
            alternatives.effects.iter().copied().zip(of_effects.iter().copied()).collect();
        effects.sort_by(|x, y| y.1.total_cmp(&x.1));
        Self { effects, none: rest[0], none_of_these: rest[1], is_met: true }
    }
}
