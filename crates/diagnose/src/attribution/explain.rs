//! Effects as a candidate: the best of their variants, fitted together with the nominal model.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use crate::effect::Effect;
use crate::effects::{Apply, Naming, Search, Sound, Variant, refinement};
use crate::likelihood::design::Design;
use crate::likelihood::engine::{Fit, FitContext, NonlinearParameter, fit};
use crate::model::augmented::AugmentedModel;
use crate::records::dataset::Dataset;

/// One effect of a candidate: which, and how its nonlinear parameters change the augmented model.
#[derive(Clone)]
pub(crate) struct EffectTerm {
    pub(crate) effect: Effect,
    /// Which law it is: the effect that offers it, and its number there. The signs of its fit may make it one of another effect.
    pub(crate) law: (Effect, usize),
    pub(crate) apply: Apply,
    pub(crate) sound: Sound,
    pub(crate) naming: Option<Naming>,
    /// Number of nonlinear parameters.
    pub(crate) count: usize,
    pub(crate) search: Search,
    /// What the law adds to the deviance for its hidden freedom.
    pub(crate) size_penalty: f64,
}

/// Rounds of a fit of one effect without the others.
const ALONE: usize = 8;

impl EffectTerm {
    /// A law of an effect, given with its number.
    pub(crate) fn of(effect: Effect, (law, variant): (usize, &Variant)) -> Self {
        Self {
            effect,
            law: (effect, law),
            apply: variant.apply.clone(),
            sound: variant.sound,
            naming: variant.naming,
            count: variant.starts[0].len(),
            search: variant.search,
            size_penalty: variant.size_penalty,
        }
    }

    /// Details of the borders: they are in the grid.
    pub(super) fn refinement() -> Self {
        let (effect, variant) = refinement();
        Self::of(effect, (0, &variant))
    }
}

impl fmt::Debug for EffectTerm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}({})", self.effect, self.count)
    }
}

/// A nominal model with any number of effects, fitted together.
#[derive(Debug, Clone)]
pub(crate) struct Hypothesis {
    pub(crate) effect_terms: Vec<EffectTerm>,
    pub(crate) fit: Fit,
    /// Added to the deviance beside the handicaps of the laws: what the knots of another fit are worth.
    pub(crate) set_back: f64,
    /// Deviance lost on the held-out records against the nominal model.
    pub(crate) held_out: f64,
}

impl Hypothesis {
    /// The nominal model alone.
    pub(crate) fn nominal(fit: Fit) -> Self {
        Self { effect_terms: Vec::new(), fit, set_back: 0.0, held_out: 0.0 }
    }

    /// The nominal model on a grid whose knots follow refinements of the borders.
    pub(crate) fn detailed(fit: Fit) -> Self {
        Self { effect_terms: vec![EffectTerm::refinement()], fit, set_back: 0.0, held_out: 0.0 }
    }

    /// Penalised deviance: Bayesian information criterion plus the penalty.
    pub(crate) fn bic(&self) -> f64 {
        let size_penalty =
            self.effect_terms.iter().map(|effect_term| effect_term.size_penalty).sum::<f64>() + self.set_back;
        self.fit.deviance + size_penalty + self.fit.parameters * (self.fit.samples as f64).ln()
    }

    /// Penalised deviance and what the held-out records add to it.
    pub(crate) fn evidence(&self) -> f64 {
        self.bic() + self.held_out
    }

    /// Whether the nonlinear parameters of the law added last only weigh the samples.
    pub(crate) fn only_weighs(&self) -> bool {
        self.effect_terms.last().is_some_and(|effect_term| effect_term.search == Search::Weights)
    }

    /// Whether the likelihood has corners in the nonlinear parameters of the law added last.
    pub(crate) fn has_corners(&self) -> bool {
        self.effect_terms.last().is_some_and(|effect_term| effect_term.search.is_by_pattern())
    }

    /// The effects, in the order they were added.
    pub(crate) fn effects(&self) -> Vec<Effect> {
        self.effect_terms.iter().map(|p| p.effect).collect()
    }

    /// Where the nonlinear parameters of one of the effects lie among those of all.
    pub(crate) fn nonlinear_of(&self, number: usize) -> Range<usize> {
        let from: usize = self.effect_terms[..number].iter().map(|effect_term| effect_term.count).sum();
        from..from + self.effect_terms[number].count
    }

    /// Whether it is what it says: neither the limit of another effect, nor one whose signs are another's, nor noise in disguise.
    pub(crate) fn may_be_a_cause(&self) -> bool {
        self.is_sound() && self.names_hold() && !self.disguises_noise()
    }

    /// The same candidate, each effect by the name that the signs of its fit give it.
    pub(crate) fn named_by_its_signs(mut self) -> Self {
        self.effect_terms = self
            .named_effect_terms()
            .map(|(effect_term, effect)| EffectTerm { effect, ..effect_term.clone() })
            .collect();
        self
    }

    /// Whether each effect has the name that the signs of its fit give it.
    fn names_hold(&self) -> bool {
        self.named_effect_terms().all(|(effect_term, effect)| effect_term.effect == effect)
    }

    /// Every effect with the name that the signs of its fit give it.
    fn named_effect_terms(&self) -> impl Iterator<Item = (&EffectTerm, Effect)> {
        self.effect_terms.iter().enumerate().map(|(number, effect_term)| {
            let nonlinear: Vec<f64> =
                self.fit.nonlinear[self.nonlinear_of(number)].iter().map(|o| o.value).collect();
            (
                effect_term,
                effect_term.naming.map_or(effect_term.effect, |naming| naming(&nonlinear, &self.fit)),
            )
        })
    }

    /// Whether an effect of it is but the colour of the noise under another name.
    pub(crate) fn disguises_noise(&self) -> bool {
        self.effect_terms
            .iter()
            .any(|effect_term| (effect_term.effect.card().is_noise_in_disguise)(&self.fit))
    }

    /// Whether every law of it is still one of its effect, not the limit at which it is another one.
    pub(crate) fn is_sound(&self) -> bool {
        let values: Vec<f64> = self.fit.nonlinear.iter().map(|o| o.value).collect();
        let mut rest = &values[..];
        self.effect_terms.iter().all(|effect_term| {
            let (nonlinear, later) = rest.split_at(effect_term.count);
            rest = later;
            (effect_term.sound)(nonlinear, &self.fit)
        })
    }

    /// The same candidate for keeping, as [`Fit::set_aside`] has it.
    #[must_use]
    pub(crate) fn set_aside(self, fixed: &Arc<Design>) -> Self {
        Self { fit: self.fit.set_aside(fixed), ..self }
    }

    /// The same candidate, less likely.
    pub(crate) fn set_back(mut self, by: f64) -> Self {
        self.set_back += by;
        self
    }

    /// One of the effects without the others, by the law and with the nonlinear parameters that it has beside them, the rest fitted
    /// anew on the same knots.
    pub(crate) fn effect_term(&self, number: usize, dataset: &Dataset) -> Option<Self> {
        let nonlinear = &self.fit.nonlinear[self.nonlinear_of(number)];
        let effect_terms = vec![self.effect_terms[number].clone()];
        let fit = self.with_effect_terms_replaced(&effect_terms, nonlinear, dataset)?;
        Some(Self { effect_terms, fit, set_back: 0.0, held_out: 0.0 })
    }

    /// The nominal model alone, fitted anew on the same knots from where it is beside the effects.
    pub(crate) fn without_effect_terms(&self, dataset: &Dataset) -> Option<Self> {
        self.with_effect_terms_replaced(&[], &[], dataset).map(Self::nominal)
    }

    fn with_effect_terms_replaced(
        &self,
        effect_terms: &[EffectTerm],
        nonlinear: &[NonlinearParameter],
        dataset: &Dataset,
    ) -> Option<Fit> {
        let values: Vec<f64> = nonlinear.iter().map(|o| o.value).collect();
        let mut linear = self.fit.linear.clone();
        linear.b.truncate(linear.a.len());
        linear.f.truncate(self.fit.grid.len());
        linear.d.clear();
        let start = linear.padded(self.fit.grid.len(), &assembled(effect_terms, &values));
        let context = FitContext { dataset, grid: &self.fit.grid, known: Some(self.fit.near()) };
        fit(context, &|values| assembled(effect_terms, values), nonlinear, &start, ALONE)
    }
}

/// The augmented model of several parts, their nonlinear parameters one after the other.
pub(crate) fn assembled(effect_terms: &[EffectTerm], values: &[f64]) -> AugmentedModel {
    let mut augmented = AugmentedModel::default();
    let mut rest = values;
    for effect_term in effect_terms {
        let (nonlinear, later) = rest.split_at(effect_term.count);
        (effect_term.apply)(nonlinear, &mut augmented);
        rest = later;
    }
    augmented
}
