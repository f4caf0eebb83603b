//! A verdict that is fitted: from the evidence of a diagnosis, the probabilities of every effect, that nothing is missing, and that the cause is no
//! candidate.
//!
//! A [conditional logit](choice) on a few [features](features) that know no effect's name, fitted by [`calibrate`] to rigs whose cause is
//! known. What it says holds for rigs drawn as those were, and their [shares](Shares) of faults, of none and of foreign ones: for others the
//! odds are to be multiplied by the ratio of the shares. Evidence outside what was met when it was fitted is told as such.

mod calibration;
mod choice;
#[cfg(test)]
pub(super) mod examples;
mod features;

use std::sync::LazyLock;

use serde::{Deserialize, Serialize};

pub use self::calibration::{CalibrateError, Example, Holds, OutOfFold, calibrate};

use self::choice::probabilities;
use self::features::{Alternatives, COEFFICIENTS, OF_ALL, OF_EFFECT};
use crate::diagnosis::Verdict;
use crate::effect::Effect;
use crate::evidence::Compared;
use crate::verdict::by_fit;

/// A feature with its coefficient and the range of what was met.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Coefficient {
    /// The feature.
    pub feature: String,
    /// What one more of it adds to the logarithm of the odds.
    pub value: f64,
    /// Least and largest value of the feature among the rigs fitted.
    pub met: [f64; 2],
}

impl Coefficient {
    fn holds(&self, x: f64) -> bool {
        // Written to six digits.
        let margin = 1e-5 * (1.0 + x.abs());
        (self.met[0] - margin..=self.met[1] + margin).contains(&x)
    }
}

/// How common causes are: shares of all rigs, summing to one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Shares {
    /// One of the effects.
    pub effect: f64,
    /// Nothing is missing.
    pub none: f64,
    /// A cause that the library does not have.
    pub none_of_these: f64,
}

/// Where a fitted verdict comes from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// The command that fitted it.
    pub command: String,
    /// What it was fitted to: studies with their seeds, and diagnoses of each.
    pub studies: Vec<String>,
    /// Diagnoses.
    pub examples: usize,
    /// Weight of the penalty, the one of least log-loss out of fold.
    pub ridge: f64,
    /// Mean of −ln P of what holds out of fold, nats a diagnosis.
    pub log_loss: f64,
    /// The same of shares alone, every effect alike.
    pub log_loss_of_shares: f64,
    /// The same of the rules that were tuned by hand.
    pub log_loss_of_rules: f64,
}

/// A fitted verdict, as its file has it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Wire")]
pub struct FittedVerdict {
    /// Where it comes from.
    pub provenance: Provenance,
    /// How common causes were among the rigs fitted.
    pub shares: Shares,
    /// Features of an effect.
    pub effect: Vec<Coefficient>,
    /// What speaks for nothing.
    pub none: Vec<Coefficient>,
    /// What speaks for none of these.
    pub none_of_these: Vec<Coefficient>,
}

#[derive(Deserialize)]
struct Wire {
    provenance: Provenance,
    shares: Shares,
    effect: Vec<Coefficient>,
    none: Vec<Coefficient>,
    none_of_these: Vec<Coefficient>,
}

impl TryFrom<Wire> for FittedVerdict {
    type Error = String;

    fn try_from(wire: Wire) -> Result<Self, String> {
        let is = |list: &[Coefficient], names: &[&str]| {
            list.len() == names.len() && list.iter().zip(names).all(|(c, name)| c.feature == *name)
        };
        if !is(&wire.effect, &OF_EFFECT.map(|feature| feature.name)) {
            return Err("`effect` must list the features of an effect in their order".to_owned());
        }
        if !is(&wire.none, &OF_ALL) || !is(&wire.none_of_these, &OF_ALL) {
            return Err(
                "`none` and `none_of_these` must list the features of all effects in their order".to_owned()
            );
        }
        let Wire { provenance, shares, effect, none, none_of_these } = wire;
        Ok(Self { provenance, shares, effect, none, none_of_these })
    }
}

/// What a feature says of an effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Contribution {
    /// The feature's name in the file.
    pub feature: &'static str,
    /// What it means, to be read after the effect's name.
    pub words: &'static str,
    /// Its value.
    pub value: f64,
    /// What it adds to the logarithm of the effect's odds.
    pub adds: f64,
}

/// What a fitted verdict says of a diagnosis, beside rules that tell it.
#[derive(Debug, Clone, PartialEq)]
pub struct SecondOpinion {
    /// Diagnoses that it was fitted to.
    pub examples: usize,
    /// How common causes are, which its probabilities hold for.
    pub shares: Shares,
    /// What it would tell; its `calibrated` says whether evidence like this was met when it was fitted.
    pub verdict: Verdict,
    /// What the rules say, before the other readings of the records are asked whether they agree.
    pub by_rules: Verdict,
    /// Every effect with a fit, the likeliest first: its probability, and what each feature says of it.
    pub effects: Vec<(Effect, f64, Vec<Contribution>)>,
    /// Probability that nothing is missing.
    pub none: f64,
    /// Probability that the cause is none of the effects.
    pub none_of_these: f64,
}

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
    fn new(alternatives: &Alternatives, p: &[f64]) -> Self {
        let (of_effects, rest) = p.split_at(alternatives.effects.len());
        let mut effects: Vec<(Effect, f64)> =
            alternatives.effects.iter().copied().zip(of_effects.iter().copied()).collect();
        effects.sort_by(|x, y| y.1.total_cmp(&x.1));
        Self { effects, none: rest[0], none_of_these: rest[1], is_met: true }
    }
}

/// Whether the likeliest effect makes a held-out record worse in every way of comparing.
fn harms(evidence: &[Compared], weighed: &Weighed) -> bool {
    let first = weighed.effects.first();
    first.is_some_and(|(effect, _)| evidence.iter().all(|says| says.harms(*effect) != Some(false)))
}

impl FittedVerdict {
    /// The one that is compiled in.
    pub fn built_in() -> &'static Self {
        static BUILT_IN: LazyLock<FittedVerdict> = LazyLock::new(|| {
            serde_json::from_str(include_str!("verdict.json")).expect("the file in the repository is whole")
        });
        &BUILT_IN
    }

    /// The same for rigs with other shares.
    #[must_use]
    pub fn with_shares(mut self, shares: Shares) -> Self {
        let odds = |new: f64, old: f64| (new / old).ln();
        let of_effect = odds(shares.effect, self.shares.effect);
        self.none[0].value += odds(shares.none, self.shares.none) - of_effect;
        self.none_of_these[0].value += odds(shares.none_of_these, self.shares.none_of_these) - of_effect;
        self.shares = shares;
        self
    }

    /// All coefficients: of effects, of nothing, of none of these.
    fn coefficients(&self) -> Vec<f64> {
        let all = self.effect.iter().chain(&self.none).chain(&self.none_of_these);
        let values: Vec<f64> = all.map(|c| c.value).collect();
        debug_assert_eq!(values.len(), COEFFICIENTS);
        values
    }

    /// Weighs the alternatives of a diagnosis.
    fn weigh(&self, alternatives: &Alternatives) -> Weighed {
        let weighed = Weighed::new(alternatives, &probabilities(&self.coefficients(), &alternatives.rows()));
        let holds = |list: &[Coefficient], x: &[f64]| list.iter().zip(x).all(|(c, x)| c.holds(*x));
        let first = weighed.effects.first().and_then(|(effect, _)| alternatives.features(*effect));
        let is_met = first.is_none_or(|x| holds(&self.effect, x)) && holds(&self.none, alternatives.of_all());
        Weighed { is_met, ..weighed }
    }

    /// What it says of what was compared, beside what the rules say; `excluded` effects are none, and one is named from a probability on.
    pub(crate) fn opinion(
        &self,
        evidence: &[Compared],
        excluded: impl Fn(Effect) -> bool,
        (name_at, by_rules): (f64, Verdict),
    ) -> SecondOpinion {
        let alternatives = Alternatives::of(evidence, excluded);
        let weighed = self.weigh(&alternatives);
        let with_features = |&(effect, p): &(Effect, f64)| {
            let contributions = alternatives.features(effect).map(|features| self.contributions(features));
            (effect, p, contributions.unwrap_or_default())
        };
        SecondOpinion {
            examples: self.provenance.examples,
            shares: self.shares,
            verdict: by_fit::verdict(&weighed, (name_at, harms(evidence, &weighed))),
            by_rules,
            effects: weighed.effects.iter().map(with_features).collect(),
            none: weighed.none,
            none_of_these: weighed.none_of_these,
        }
    }

    fn contributions(&self, features: &[f64; OF_EFFECT.len()]) -> Vec<Contribution> {
        let one =
            |((feature, coefficient), value): ((&features::Feature, &Coefficient), &f64)| Contribution {
                feature: feature.name,
                words: feature.words,
                value: *value,
                adds: coefficient.value * value,
            };
        OF_EFFECT.iter().zip(&self.effect).zip(features).map(one).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_verdict_compiled_in_is_whole_and_says_where_it_comes_from() {
        let verdict = FittedVerdict::built_in();
        let Shares { effect, none, none_of_these } = verdict.shares;
        assert!((effect + none + none_of_these - 1.0).abs() < 1e-5);
        let from = &verdict.provenance;
        assert!(from.examples > 100 && !from.studies.is_empty());
        assert!(from.log_loss < from.log_loss_of_shares && from.log_loss < from.log_loss_of_rules);
        // What no coefficient may say.
        let of = |name: &str| verdict.effect.iter().find(|c| c.feature == name).map(|c| c.value);
        assert!(of("harm") <= Some(0.0) && of("closure_held") >= Some(0.0));
    }
}
