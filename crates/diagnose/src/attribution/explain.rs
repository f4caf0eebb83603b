//! Effects as an explanation: the best of their variants, fitted together with the nominal model.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use crate::effect::Effect;
use crate::effects::{Apply, Naming, Search, Sound, Variant, details};
use crate::likelihood::design::Design;
use crate::likelihood::engine::{Fit, Ground, NonlinearParameter, fit};
use crate::model::assembly::Assembly;
use crate::records::campaign::Campaign;

/// One effect of an explanation: which, and how its nonlinear parameters change the assembly.
#[derive(Clone)]
pub(crate) struct Part {
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
    pub(crate) handicap: f64,
}

/// Rounds of a fit of one effect without the others.
const ALONE: usize = 8;

impl Part {
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
            handicap: variant.handicap,
        }
    }

    /// Details of the borders: they are in the grid.
    pub(super) fn details() -> Self {
        let (effect, variant) = details();
        Self::of(effect, (0, &variant))
    }
}

impl fmt::Debug for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}({})", self.effect, self.count)
    }
}

/// A nominal model with any number of effects, fitted together.
#[derive(Debug, Clone)]
pub(crate) struct Explanation {
    pub(crate) parts: Vec<Part>,
    pub(crate) fit: Fit,
    /// Added to the deviance beside the handicaps of the laws: what the knots of another fit are worth.
    pub(crate) set_back: f64,
    /// Deviance lost on the held-out records against the nominal model.
    pub(crate) held_out: f64,
}

impl Explanation {
    /// The nominal model alone.
    pub(crate) fn nominal(fit: Fit) -> Self {
        Self { parts: Vec::new(), fit, set_back: 0.0, held_out: 0.0 }
    }

    /// The nominal model on a grid whose knots follow details of the borders.
    pub(crate) fn detailed(fit: Fit) -> Self {
        Self { parts: vec![Part::details()], fit, set_back: 0.0, held_out: 0.0 }
    }

    /// Penalised deviance: Bayesian information criterion plus the handicap.
    pub(crate) fn bic(&self) -> f64 {
        let handicap = self.parts.iter().map(|part| part.handicap).sum::<f64>() + self.set_back;
        self.fit.deviance + handicap + self.fit.parameters * (self.fit.samples as f64).ln()
    }

    /// Penalised deviance and what the held-out records add to it.
    pub(crate) fn evidence(&self) -> f64 {
        self.bic() + self.held_out
    }

    /// Whether the nonlinear parameters of the law added last only weigh the samples.
    pub(crate) fn only_weighs(&self) -> bool {
        self.parts.last().is_some_and(|part| part.search == Search::Weights)
    }

    /// Whether the likelihood has corners in the nonlinear parameters of the law added last.
    pub(crate) fn has_corners(&self) -> bool {
        self.parts.last().is_some_and(|part| part.search.is_by_pattern())
    }

    /// The effects, in the order they were added.
    pub(crate) fn effects(&self) -> Vec<Effect> {
        self.parts.iter().map(|p| p.effect).collect()
    }

    /// Where the nonlinear parameters of one of the effects lie among those of all.
    pub(crate) fn nonlinear_of(&self, number: usize) -> Range<usize> {
        let from: usize = self.parts[..number].iter().map(|part| part.count).sum();
        from..from + self.parts[number].count
    }

    /// Whether it is what it says: neither the limit of another effect, nor one whose signs are another's, nor noise in disguise.
    pub(crate) fn may_be_a_cause(&self) -> bool {
        self.is_sound() && self.names_hold() && !self.disguises_noise()
    }

    /// The same explanation, each effect by the name that the signs of its fit give it.
    pub(crate) fn named_by_its_signs(mut self) -> Self {
        self.parts = self.named_parts().map(|(part, effect)| Part { effect, ..part.clone() }).collect();
        self
    }

    /// Whether each effect has the name that the signs of its fit give it.
    fn names_hold(&self) -> bool {
        self.named_parts().all(|(part, effect)| part.effect == effect)
    }

    /// Every effect with the name that the signs of its fit give it.
    fn named_parts(&self) -> impl Iterator<Item = (&Part, Effect)> {
        self.parts.iter().enumerate().map(|(number, part)| {
            let nonlinear: Vec<f64> =
                self.fit.nonlinear[self.nonlinear_of(number)].iter().map(|o| o.value).collect();
            (part, part.naming.map_or(part.effect, |naming| naming(&nonlinear, &self.fit)))
        })
    }

    /// Whether an effect of it is but the colour of the noise under another name.
    pub(crate) fn disguises_noise(&self) -> bool {
        self.parts.iter().any(|part| (part.effect.card().is_noise_in_disguise)(&self.fit))
    }

    /// Whether every law of it is still one of its effect, not the limit at which it is another one.
    pub(crate) fn is_sound(&self) -> bool {
        let values: Vec<f64> = self.fit.nonlinear.iter().map(|o| o.value).collect();
        let mut rest = &values[..];
        self.parts.iter().all(|part| {
            let (nonlinear, later) = rest.split_at(part.count);
            rest = later;
            (part.sound)(nonlinear, &self.fit)
        })
    }

    /// The same explanation for keeping, as [`Fit::set_aside`] has it.
    #[must_use]
    pub(crate) fn set_aside(self, held: &Arc<Design>) -> Self {
        Self { fit: self.fit.set_aside(held), ..self }
    }

    /// The same explanation, less likely.
    pub(crate) fn set_back(mut self, by: f64) -> Self {
        self.set_back += by;
        self
    }

    /// One of the effects without the others, by the law and with the nonlinear parameters that it has beside them, the rest fitted
    /// anew on the same knots.
    pub(crate) fn part(&self, number: usize, campaign: &Campaign) -> Option<Self> {
        let nonlinear = &self.fit.nonlinear[self.nonlinear_of(number)];
        let parts = vec![self.parts[number].clone()];
        let fit = self.with_parts_replaced(&parts, nonlinear, campaign)?;
        Some(Self { parts, fit, set_back: 0.0, held_out: 0.0 })
    }

    /// The nominal model alone, fitted anew on the same knots from where it is beside the effects.
    pub(crate) fn without_parts(&self, campaign: &Campaign) -> Option<Self> {
        self.with_parts_replaced(&[], &[], campaign).map(Self::nominal)
    }

    fn with_parts_replaced(
        &self,
        parts: &[Part],
        nonlinear: &[NonlinearParameter],
        campaign: &Campaign,
    ) -> Option<Fit> {
        let values: Vec<f64> = nonlinear.iter().map(|o| o.value).collect();
        let mut linear = self.fit.linear.clone();
        linear.b.truncate(linear.a.len());
        linear.f.truncate(self.fit.grid.len());
        linear.d.clear();
        let start = linear.padded(self.fit.grid.len(), &assembled(parts, &values));
        let ground = Ground { campaign, grid: &self.fit.grid, known: Some(self.fit.near()) };
        fit(ground, &|values| assembled(parts, values), nonlinear, &start, ALONE)
    }
}

/// The assembly of several parts, their nonlinear parameters one after the other.
pub(crate) fn assembled(parts: &[Part], values: &[f64]) -> Assembly {
    let mut assembly = Assembly::default();
    let mut rest = values;
    for part in parts {
        let (nonlinear, later) = rest.split_at(part.count);
        (part.apply)(nonlinear, &mut assembly);
        rest = later;
    }
    assembly
}
