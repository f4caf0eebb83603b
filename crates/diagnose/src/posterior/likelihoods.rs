//! Likelihoods of fits join the probabilities by evidence.

use super::prior::Prior;
use crate::effect::Effect;

/// What the fit of an effect says beside a model of a known structure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FittedEffect {
    /// The effect.
    pub effect: Effect,
    /// `Δ`: drop of the penalised deviance, less what is lost on held-out records.
    pub gain: f64,
    /// Whether a held-out record refutes it.
    pub is_refuted: bool,
}

/// What the fits of all effects say.
#[derive(Debug, Clone, PartialEq)]
pub struct Fits {
    /// One an effect.
    pub effects: Vec<FittedEffect>,
    /// `λ`: deviance that causes in general would still gain beside the best.
    pub left: f64,
}

/// Fits where the model's structure is known, and the probabilities that they join: the order is declared, or experiments were designed, and models
/// predict one sample ahead.
///
/// ```text
/// w(effect k)       = p·exp(−(Δ₁ − Δ_k)/2T)      Δ_k from 0 on, 0 without a fit; Δ₁ the largest
/// w(none of these)  = p·exp((λ − c)/2T)
/// w(nothing)        = p·exp(−(Δ₁ + λ − s)/2)     s what a search over effects, laws and shapes gains in noise
/// T                 = 1 + τ·λ                    laws are never exact: differences count against what the best leaves
/// p′                = (1 − ε)·w/Σw + ε·p
/// ```
///
/// A half of the drop of the Bayesian information criterion is the logarithm of a ratio of marginal likelihoods (R. E. Kass, A. E. Raftery, "Bayes factors",
/// J. Am. Stat. Assoc. 90, 1995). Of an effect that a held-out record refutes, the share `ρ` of `w` is that of none of these.
#[derive(Debug, Clone, PartialEq)]
pub struct Likelihoods {
    /// The fits.
    pub fits: Fits,
    /// The probabilities before.
    pub before: Probabilities,
}

/// `τ`, `c`, `ε` and `ρ`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weights {
    /// `τ`.
    pub temper: f64,
    /// `c`.
    pub complexity: f64,
    /// `ε`.
    pub doubt: f64,
    /// `ρ`.
    pub refuted: f64,
}

/// Probabilities of causes, in the order of the caller, that nothing is missing, and that it is none of these.
#[derive(Debug, Clone, PartialEq)]
pub struct Probabilities {
    /// Of the causes, each with its effect if a diagnosis can name it.
    pub causes: Vec<(Option<Effect>, f64)>,
    /// That nothing is missing.
    pub none: f64,
    /// That it is none of these.
    pub none_of_these: f64,
}

impl Weights {
    /// Within the 95 % intervals of the likeliest on made rigs with an order that is declared, by the example `likelihoods`.
    pub const FITTED: Self = Self { temper: 0.8, complexity: 16.0, doubt: 0.03, refuted: 0.5 };
}

impl Probabilities {
    /// Those of a prior: effects that are possible are as likely as each other.
    pub(super) fn of_prior(prior: Prior, causes: impl Iterator<Item = (Option<Effect>, bool)>) -> Self {
        let causes: Vec<(Option<Effect>, bool)> = causes.collect();
        let possible = causes.iter().filter(|(_, is_possible)| *is_possible).count().max(1) as f64;
        let p = |is_possible: bool| if is_possible { prior.effect / possible } else { 0.0 };
        Self {
            causes: causes.iter().map(|(effect, is_possible)| (*effect, p(*is_possible))).collect(),
            none: prior.none,
            none_of_these: prior.none_of_these,
        }
    }
}

impl Fits {
    /// Whether they outweigh what evidence may say: the best leaves nothing, and no held-out record refutes it.
    pub fn decide(&self) -> bool {
        let best = self.effects.iter().max_by(|x, y| x.gain.total_cmp(&y.gain));
        self.left == 0.0 && best.is_none_or(|best| !best.is_refuted)
    }

    fn of(&self, effect: Option<Effect>) -> Option<&FittedEffect> {
        self.effects.iter().find(|fit| Some(fit.effect) == effect)
    }
}

impl Likelihoods {
    /// `s`: penalised deviance that a search over some twenty effects, their laws and their shapes gains in noise.
    pub const SEARCHED: f64 = 40.0;

    /// The probabilities joined by the fits.
    pub fn joined(&self, weights: &Weights) -> Probabilities {
        let Self { fits, before } = self;
        let temperature = 1.0 + weights.temper * fits.left;
        let gain = |effect| fits.of(effect).map_or(0.0, |fit| fit.gain.max(0.0));
        let best = fits.effects.iter().map(|fit| fit.gain).fold(0.0, f64::max);
        let mut none_of_these = before.none_of_these * exp((fits.left - weights.complexity) / temperature);
        let mut causes = Vec::with_capacity(before.causes.len());
        for (effect, p) in &before.causes {
            let weight = p * exp((gain(*effect) - best) / temperature);
            let passed =
                if fits.of(*effect).is_some_and(|fit| fit.is_refuted) { weights.refuted } else { 0.0 };
            none_of_these += passed * weight;
            causes.push((1.0 - passed) * weight);
        }
        let none = before.none * exp(Self::SEARCHED - best - fits.left);
        let sum = (none + none_of_these + causes.iter().sum::<f64>()).max(f64::MIN_POSITIVE);
        let mixed = |weight: f64, p: f64| (1.0 - weights.doubt) * weight / sum + weights.doubt * p;
        Probabilities {
            causes: causes
                .iter()
                .zip(&before.causes)
                .map(|(w, (effect, p))| (*effect, mixed(*w, *p)))
                .collect(),
            none: mixed(none, before.none),
            none_of_these: mixed(none_of_these, before.none_of_these),
        }
    }
}

/// Of half a deviance, within the range of numbers.
fn exp(deviance: f64) -> f64 {
    libm::exp((0.5 * deviance).clamp(-300.0, 300.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn before() -> Probabilities {
        let causes = vec![
            (Some(Effect::Backlash), 0.3),
            (Some(Effect::Creep), 0.2),
            (None, 0.1),
            (Some(Effect::Stribeck), 0.1),
        ];
        Probabilities { causes, none: 0.2, none_of_these: 0.1 }
    }

    fn of(fits: &[(Effect, f64, bool)], left: f64) -> Probabilities {
        let fit =
            |&(effect, gain, is_refuted): &(Effect, f64, bool)| FittedEffect { effect, gain, is_refuted };
        let fits = Fits { effects: fits.iter().map(fit).collect(), left };
        let joined = Likelihoods { fits, before: before() }.joined(&Weights::FITTED);
        let sum = joined.causes.iter().map(|(_, p)| p).sum::<f64>() + joined.none + joined.none_of_these;
        assert!((sum - 1.0).abs() < 1e-12, "probabilities sum to {sum}");
        joined
    }

    #[test]
    fn the_ratio_of_two_effects_is_that_of_their_marginal_likelihoods() {
        let exact = Weights { doubt: 0.0, ..Weights::FITTED };
        let fit = |effect, gain| FittedEffect { effect, gain, is_refuted: false };
        let fits = Fits { effects: vec![fit(Effect::Backlash, 500.0), fit(Effect::Creep, 503.0)], left: 0.0 };
        let joined = Likelihoods { fits, before: before() }.joined(&exact);
        let ratio = joined.causes[0].1 / joined.causes[1].1;
        assert!((ratio - 1.5 * (-1.5_f64).exp()).abs() < 1e-12, "{ratio}");
        assert!(joined.causes[3].1 < 1e-100 && joined.none < 1e-90);
    }

    #[test]
    fn a_fit_that_leaves_nothing_is_sure_up_to_a_doubt() {
        let sure = of(&[(Effect::Backlash, 5000.0, false), (Effect::Creep, 4000.0, false)], 0.0);
        assert!(sure.causes[0].1 > 0.96 && sure.causes[0].1 < 0.985, "{sure:?}");
    }

    #[test]
    fn where_much_is_left_differences_say_little_and_it_may_be_none_of_these() {
        let inexact = of(&[(Effect::Backlash, 5000.0, false), (Effect::Creep, 4000.0, false)], 4000.0);
        let ratio = inexact.causes[0].1 / inexact.causes[1].1;
        assert!(ratio > 1.5 && ratio < 2.5, "{ratio}");
        assert!(inexact.none_of_these > before().none_of_these && inexact.none < 0.01);
    }

    #[test]
    fn where_nothing_is_gained_nothing_is_missing() {
        let silent = of(&[(Effect::Backlash, 6.0, false), (Effect::Creep, -9.0, false)], 0.0);
        assert!(silent.none > 0.95, "{silent:?}");
        // A gap that no fit explains is a gap.
        let unexplained = of(&[(Effect::Backlash, 6.0, false)], 3000.0);
        assert!(unexplained.none < 0.01, "{unexplained:?}");
    }

    #[test]
    fn a_refuted_effect_shares_with_none_of_these() {
        let refuted = of(&[(Effect::Backlash, 5000.0, true), (Effect::Creep, 100.0, false)], 0.0);
        let [first, other] = [refuted.causes[0].1, refuted.none_of_these];
        assert!((first - other).abs() < 0.02 && first > 0.45, "{refuted:?}");
    }
}
