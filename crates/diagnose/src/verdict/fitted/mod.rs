//! A verdict that is fitted: from the evidence of a diagnosis, the probabilities of every effect, that nothing is missing, and that the cause is no
//! candidate.
//!
//! A [conditional logit](choice) on a few [features](features) that know no effect's name, among them what rules tuned by hand find, fitted by [`calibrate`] to rigs whose cause is
//! known. What it says holds for rigs drawn as those were, and their [shares](Shares) of faults, of none and of foreign ones: for others the
//! odds are to be multiplied by the ratio of the shares. Evidence outside what was met when it was fitted is reported as such.

mod calibration;
mod choice;
#[cfg(test)]
pub(super) mod examples;
mod features;
mod shares;
pub(super) mod weighed;

use std::sync::LazyLock;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use self::calibration::CalibrateError;
pub use self::calibration::Example;
pub use self::calibration::Holds;
pub use self::calibration::OutOfFold;
pub use self::calibration::calibrate;
pub(crate) use self::features::RulesSay;
pub use self::shares::Shares;
use self::weighed::Weighed;

use self::choice::probabilities;
use self::features::{Alternatives, COEFFICIENTS, OF_ALL, OF_EFFECT};
use crate::comparison::Compared;
use crate::effect::Effect;
use crate::verdict::agreement::agrees;
use crate::verdict::answer::{Status, Verdict};
use crate::verdict::by_fit;

/// A feature with its coefficient and the range of what was met.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
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

/// How often a cause that rules name was the right one where all readings of the records agree on it, and the fitted verdict finds it
/// with its confounded effects likelier than all else together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Agreed {
    /// Right ones, or confounded effects of these.
    pub right: usize,
    /// All that could be judged, each predicted from other rigs.
    pub of: usize,
}

impl Agreed {
    /// Probability that the next one is right: Laplace's rule of succession.
    pub(crate) fn rate(self) -> f64 {
        (self.right as f64 + 1.0) / (self.of as f64 + 2.0)
    }

    /// Probability of a cause on which all readings agree: the one that the fitted verdict gives to it, or this rate, where it counts and that is
    /// larger.
    pub(crate) fn probability(self, cause: AgreedOn) -> f64 {
        if cause.counts() { cause.fitted.max(self.rate()) } else { cause.fitted }
    }
}

/// A cause on which all readings agree.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AgreedOn {
    /// Probability that the fitted verdict gives to it.
    pub fitted: f64,
    /// The same of it and its confounded effects.
    pub with_confounded_effects: f64,
}

impl AgreedOn {
    /// Whether it is among those counted: with its confounded effects likelier than all else together.
    pub fn counts(self) -> bool {
        self.with_confounded_effects > 0.5
    }
}

/// Where a fitted verdict comes from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
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

/// The verdict as it was fitted: `calibrate --out`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "Wire")]
pub struct FittedVerdict {
    /// Where it comes from, and its log-loss out of fold beside that of shares alone and of the rules.
    pub provenance: Provenance,
    /// How common causes were among the rigs fitted.
    pub shares: Shares,
    /// How often a cause that rules name was the right one where all readings of the records agree on it.
    pub agreed: Agreed,
    /// What speaks for an effect.
    pub effect: Vec<Coefficient>,
    /// What speaks for nothing.
    pub none: Vec<Coefficient>,
    /// What speaks for a cause that is no candidate.
    pub none_of_these: Vec<Coefficient>,
}

#[derive(Deserialize, JsonSchema)]
struct Wire {
    provenance: Provenance,
    shares: Shares,
    agreed: Agreed,
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
        let Wire { provenance, shares, agreed, effect, none, none_of_these } = wire;
        Ok(Self { provenance, shares, agreed, effect, none, none_of_these })
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

/// What a fitted verdict says of a diagnosis, and what rules say of it.
#[derive(Debug, Clone, PartialEq)]
pub struct SecondOpinion {
    /// Diagnoses that it was fitted to.
    pub examples: usize,
    /// How common causes are, which its probabilities hold for.
    pub shares: Shares,
    /// What it would show by itself; its `calibrated` says whether evidence like this was met when it was fitted.
    pub verdict: Verdict,
    /// What rules that were tuned by hand would show.
    pub by_rules: Verdict,
    /// The effect that these find the likeliest candidate, with its probability; none where that is none.
    pub likeliest_by_rules: Option<(Effect, f64)>,
    /// Probability of the cause that rules name, where all readings of the records agree on it.
    pub agreed: Option<f64>,
    /// Every effect with a fit, the likeliest first: its probability, and what each feature says of it.
    pub effects: Vec<(Effect, f64, Vec<Contribution>)>,
    /// Probability that nothing is missing.
    pub none: f64,
    /// Probability that the cause is none of the effects.
    pub none_of_these: f64,
}

impl SecondOpinion {
    /// The verdict as it is reported, where a cause is named from a probability on.
    pub(crate) fn reported(&self, name_at: f64) -> Verdict {
        reported(&self.verdict, &self.by_rules, self.agreed, name_at)
    }

    /// Probability of every effect as it is reported, and of nothing and of none of these: those of the fitted verdict, unless all readings agree on a
    /// cause; then the others share the rest as they did.
    pub(crate) fn weights(&self) -> (Vec<(Effect, f64)>, [f64; 2]) {
        let mut effects: Vec<(Effect, f64)> =
            self.effects.iter().map(|(effect, p, _)| (*effect, *p)).collect();
        let rest = [self.none, self.none_of_these];
        let (Some(agreed), [cause]) = (self.agreed, &self.by_rules.effects[..]) else {
            return (effects, rest);
        };
        let of_others = 1.0 - effects.iter().find(|(effect, _)| effect == cause).map_or(0.0, |(_, p)| *p);
        let share = (1.0 - agreed) / of_others.max(f64::MIN_POSITIVE);
        effects.iter_mut().for_each(|(effect, p)| *p = if effect == cause { agreed } else { *p * share });
        (effects, rest.map(|p| p * share))
    }
}

/// The verdict as it is reported, from the fitted one and that by rules; `agreed` is the probability of the cause that these name, where all
/// readings agree on it.
///
/// ```text
/// named         such a cause from a probability of `name_at` on; two causes at once, which only rules weigh
/// ambiguous     such a cause by itself, where it is less probable and the fitted verdict shows no cause or class
/// else          what the fitted verdict shows; where that is no cause, rules say whether parameters are off, the held-out records were taken under
///               other conditions, or something is left, and it says with what probability. Where they find that another order or delay does what
///               the effect would do, that is reported
/// ```
pub(super) fn reported(fitted: &Verdict, rules: &Verdict, agreed: Option<f64>, name_at: f64) -> Verdict {
    let weighed = |probability| Verdict { probability, calibrated: fitted.calibrated, ..rules.clone() };
    let is_silent = matches!(fitted.status, Status::None | Status::Unexplained);
    let is_dynamics = |effect: &Effect| effect.card().room.is_some();
    let are_dynamics = fitted.effects.iter().chain(&fitted.class).all(is_dynamics);
    match (rules.status, agreed) {
        (Status::Refit, _) if !is_silent && are_dynamics => rules.clone(),
        (Status::Named, _) if rules.effects.len() > 1 => rules.clone(),
        (Status::Named, Some(p)) if p >= name_at => weighed(p),
        (Status::Named, Some(p)) if is_silent => Verdict {
            status: Status::Ambiguous,
            effects: Vec::new(),
            class: rules.effects.clone(),
            corrected_by: None,
            ..weighed(p)
        },
        (Status::None | Status::Refit | Status::Unexplained, _) if is_silent => weighed(fitted.probability),
        _ => fitted.clone(),
    }
}

/// Whether the likeliest effect makes a held-out record worse in every comparison.
fn degrades_validation(evidence: &[Compared], weighed: &Weighed) -> bool {
    let first = weighed.effects.first();
    first.is_some_and(|(effect, _)| {
        evidence.iter().all(|says| says.degrades_validation(*effect) != Some(false))
    })
}

/// The one cause that rules name, where all readings agree on it and it degrades no held-out record by that analysis; that is the first.
fn agreed_on(
    by_rules: &Verdict,
    evidence: &[Compared],
    weighed: &Weighed,
    excluded: impl Fn(Effect) -> bool,
) -> Option<AgreedOn> {
    let (Status::Named, &[cause]) = (by_rules.status, &by_rules.effects[..]) else { return None };
    let degrades_validation = evidence.first().and_then(|says| says.degrades_validation(cause)) == Some(true);
    let likeliest = weighed.effects.first().map(|(effect, _)| *effect);
    if degrades_validation || !agrees(cause, evidence, likeliest, excluded) {
        return None;
    }
    let of =
        |is: &dyn Fn(Effect) -> bool| weighed.effects.iter().filter(|(e, _)| is(*e)).map(|(_, p)| p).sum();
    let fitted = of(&|effect| effect == cause);
    Some(AgreedOn {
        fitted,
        with_confounded_effects: of(&|effect| {
            effect == cause || cause.confounded_effects().contains(&effect)
        }),
    })
}

impl FittedVerdict {
    /// The one that is compiled in.
    pub(crate) fn built_in() -> &'static Self {
        static BUILT_IN: LazyLock<FittedVerdict> = LazyLock::new(|| {
            serde_json::from_str(include_str!("verdict.json")).expect("the file in the repository is whole")
        });
        &BUILT_IN
    }

    /// The same for rigs with other shares.
    #[must_use]
    pub(crate) fn with_shares(mut self, shares: Shares) -> Self {
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

    /// What it says of what was compared; `excluded` effects are none, and one is named from a probability on.
    pub(crate) fn opinion(
        &self,
        evidence: &[Compared],
        excluded: impl Fn(Effect) -> bool,
        (by_rules, likeliest_by_rules): (Verdict, Option<(Effect, f64)>),
        name_at: f64,
    ) -> SecondOpinion {
        let rules = RulesSay::of(by_rules.status, likeliest_by_rules);
        let alternatives = Alternatives::of(evidence, rules, &excluded);
        let weighed = self.weigh(&alternatives);
        let agreed = agreed_on(&by_rules, evidence, &weighed, &excluded);
        let with_features = |&(effect, p): &(Effect, f64)| {
            let contributions = alternatives.features(effect).map(|features| self.contributions(features));
            (effect, p, contributions.unwrap_or_default())
        };
        SecondOpinion {
            examples: self.provenance.examples,
            shares: self.shares,
            verdict: by_fit::verdict(&weighed, (name_at, degrades_validation(evidence, &weighed))),
            agreed: agreed.map(|p| self.agreed.probability(p)),
            by_rules,
            likeliest_by_rules,
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
    use crate::verdict::answer::naming_nothing;

    fn saying(status: Status, effects: &[Effect], probability: f64) -> Verdict {
        Verdict { effects: effects.to_vec(), ..naming_nothing(status, None, probability) }
    }

    #[test]
    fn rules_name_where_all_agree_and_describe_what_kind_of_nothing_it_is() {
        let rules = saying(Status::Named, &[Effect::Creep], 0.99);
        let fitted = saying(Status::Unexplained, &[], 0.3);
        let reported = |fitted: &Verdict, rules: &Verdict, agreed| reported(fitted, rules, agreed, 0.85);
        let agreed = reported(&fitted, &rules, Some(0.9));
        assert_eq!((agreed.status, &agreed.effects[..]), (Status::Named, &[Effect::Creep][..]));
        assert_eq!(agreed.probability, 0.9);
        assert_eq!(reported(&fitted, &rules, None), fitted);
        let weak = reported(&fitted, &rules, Some(0.4));
        assert_eq!(
            (weak.status, &weak.class[..], weak.probability),
            (Status::Ambiguous, &[Effect::Creep][..], 0.4)
        );
        assert!(weak.effects.is_empty());
        let refit = reported(&fitted, &saying(Status::Refit, &[], 0.8), None);
        assert_eq!((refit.status, refit.probability), (Status::Refit, 0.3));
        let named = saying(Status::Named, &[Effect::Resonance], 0.87);
        assert_eq!(reported(&named, &saying(Status::None, &[], 0.9), None), named);
        let both = saying(Status::Named, &[Effect::Creep, Effect::Backlash], 0.9);
        assert_eq!(reported(&named, &both, None), both);
    }

    #[test]
    fn probabilities_as_reported_sum_to_one_and_hold_what_agreement_is_worth() {
        let effects = vec![(Effect::Creep, 0.3, Vec::new()), (Effect::Backlash, 0.2, Vec::new())];
        let mut opinion = SecondOpinion {
            examples: 1,
            shares: Shares { effect: 0.5, none: 0.3, none_of_these: 0.2 },
            verdict: saying(Status::Unexplained, &[], 0.1),
            by_rules: saying(Status::Named, &[Effect::Creep], 0.99),
            likeliest_by_rules: None,
            agreed: None,
            effects,
            none: 0.4,
            none_of_these: 0.1,
        };
        assert_eq!(opinion.weights(), (vec![(Effect::Creep, 0.3), (Effect::Backlash, 0.2)], [0.4, 0.1]));
        opinion.agreed = Some(0.86);
        let (effects, rest) = opinion.weights();
        assert_eq!(effects[0], (Effect::Creep, 0.86));
        assert!((effects[1].1 / rest[1] - 2.0).abs() < 1e-12);
        assert!((effects[0].1 + effects[1].1 + rest[0] + rest[1] - 1.0).abs() < 1e-12);
    }

    #[test]
    fn agreement_counts_where_the_fitted_verdict_finds_the_cause_likelier_than_not() {
        assert_eq!(Agreed::default().rate(), 0.5);
        let agreed = Agreed { right: 8, of: 8 };
        assert!((agreed.rate() - 0.9).abs() < 1e-12);
        let on = |fitted, with_confounded_effects| {
            agreed.probability(AgreedOn { fitted, with_confounded_effects })
        };
        assert_eq!([on(0.3, 0.4), on(0.4, 0.6), on(0.95, 0.95)], [0.3, agreed.rate(), 0.95]);
    }

    #[test]
    fn what_another_order_does_as_well_is_no_cause() {
        let rules = saying(Status::Refit, &[], 0.8);
        let reported = |effect| reported(&saying(Status::Named, &[effect], 0.95), &rules, None, 0.85);
        assert_eq!(reported(Effect::Resonance), rules);
        assert_eq!(reported(Effect::Stribeck).effects, [Effect::Stribeck]);
    }

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
        assert!(of("harm") <= Some(0.0) && of("margin_held") >= Some(0.0));
    }
}
