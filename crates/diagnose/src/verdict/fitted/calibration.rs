//! Fitting the verdict to rigs whose cause is known.
//!
//! What is predicted shares neither base rig nor law with what was fitted: bases and laws are dealt into [`FOLDS`] folds each, and the
//! examples of base fold `i` and law fold `j` are predicted by a fit to those that are in neither. A rig without fault has no law: it is
//! predicted by base alone.

use serde::{Deserialize, Serialize};

use super::choice::{Choice, Sign, fitted, probabilities};
use super::features::{Alternatives, COEFFICIENTS, OF_ALL, OF_EFFECT, RulesSay};
use super::{
    Agreed, AgreedOn, Coefficient, FittedVerdict, Provenance, Shares, Weighed, agreed_on,
    degrades_validation, reported,
};
use crate::comparison::Compared;
use crate::effect::Effect;
use crate::verdict::answer::Verdict;
use crate::verdict::by_fit;

/// Folds of the base rigs, and of the laws.
const FOLDS: usize = 10;

/// Weights of the penalty tried: standard deviations of a coefficient from 3 down to 0.2.
const RIDGES: [f64; 6] = [0.1, 0.3, 1.0, 3.0, 10.0, 30.0];

/// What holds of a rig; several where nobody can show which of them is seen.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Holds {
    /// These effects.
    pub effects: Vec<Effect>,
    /// Nothing is missing.
    pub none: bool,
    /// A cause that the library does not have.
    pub none_of_these: bool,
}

/// A diagnosis of a rig whose cause is known.
#[derive(Debug, Clone, PartialEq)]
pub struct Example {
    /// The base rig.
    pub base: String,
    /// The law of the fault, where there is one.
    pub law: Option<String>,
    /// What the records say.
    pub evidence: Vec<Compared>,
    /// Effects that were no candidates.
    pub excluded: Vec<Effect>,
    /// What holds; nothing where nobody knows: such an example is predicted, and fitted to nothing.
    pub holds: Holds,
    /// What rules tuned by hand show, and what they find likeliest.
    pub rules: (Verdict, Option<(Effect, f64)>),
    /// Probability that these gave to what holds.
    pub by_rules: f64,
}

impl Example {
    fn rules_say(&self) -> RulesSay {
        RulesSay::of(self.rules.0.status, self.rules.1)
    }
}

impl Holds {
    /// Nobody knows.
    fn is_unknown(&self) -> bool {
        self.effects.is_empty() && !self.none && !self.none_of_these
    }
}

/// What was predicted of an example by a fit that knows neither its base nor its law.
#[derive(Debug, Clone, PartialEq)]
pub struct OutOfFold(Weighed);

impl OutOfFold {
    /// The verdict with a threshold of naming; `example` is what was predicted.
    pub fn verdict(&self, example: &Example, name_at: f64) -> Verdict {
        by_fit::verdict(&self.0, (name_at, degrades_validation(&example.evidence, &self.0)))
    }

    /// The one cause that rules name, where all readings agree on it.
    pub fn agreed_on(&self, example: &Example) -> Option<AgreedOn> {
        agreed_on(&example.rules.0, &example.evidence, &self.0, |effect| example.excluded.contains(&effect))
    }

    /// What is reported, for what agreement is worth.
    pub fn reported(&self, example: &Example, agreed: Agreed, name_at: f64) -> Verdict {
        let agreed = self.agreed_on(example).map(|p| agreed.probability(p));
        reported(&self.verdict(example, name_at), &example.rules.0, agreed, name_at)
    }

    /// The likeliest candidate: an effect, or `none` or `unexplained`.
    pub fn top(&self) -> (&'static str, f64) {
        let rest = [("none", self.0.none), ("unexplained", self.0.none_of_these)];
        let effects = self.0.effects.iter().map(|(effect, p)| (effect.name(), *p));
        effects.chain(rest).fold(("none", 0.0), |best, x| if x.1 > best.1 { x } else { best })
    }
}

/// Examples that no verdict can be fitted to.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum CalibrateError {
    /// A kind of rig is missing.
    #[error("no diagnosis of a rig with {0} among {1}: a probability of that cannot be fitted")]
    Missing(&'static str, usize),
    /// Too few bases or laws to predict any from others.
    #[error("{0} base rigs and {1} laws are too few: each is predicted from others, which takes 2 of both")]
    TooFew(usize, usize),
}

/// Fits a verdict, and predicts every example out of fold; what agreement is worth is left to be counted. `studies` and `command` say where the examples come from.
///
/// # Errors
/// [`CalibrateError`] where examples of a kind are missing.
pub fn calibrate(
    examples: &[Example],
    (command, studies): (&str, &[String]),
) -> Result<(FittedVerdict, Vec<OutOfFold>), CalibrateError> {
    let is_known: Vec<bool> = examples.iter().map(|e| !e.holds.is_unknown()).collect();
    let known = |choices: &[Choice]| -> Vec<Choice> {
        choices.iter().zip(&is_known).filter(|(_, known)| **known).map(|(choice, _)| choice.clone()).collect()
    };
    let shares = shares(examples)?;
    let folds = Folds::of(examples)?;
    let alternatives: Vec<Alternatives> = examples.iter().map(alternatives).collect();
    let choices: Vec<Choice> = examples.iter().zip(&alternatives).map(|(e, a)| choice(e, a)).collect();
    let tried = RIDGES.map(|ridge| (ridge, folds.predicted(&choices, ridge)));
    let loss_of = |predicted: &[Vec<f64>]| loss(&choices, predicted);
    let best = tried.iter().min_by(|x, y| loss_of(&x.1).total_cmp(&loss_of(&y.1)));
    let (ridge, predicted) = best.expect("weights are tried");
    let labelled = known(&choices);
    let coefficients = fitted(&labelled, &signs(), *ridge);
    let count = labelled.len() as f64;
    let by_shares = labelled.iter().map(|choice| -share_of(choice, shares).ln()).sum::<f64>() / count;
    let reported = examples.iter().filter(|e| !e.holds.is_unknown());
    let by_rules = reported.map(|e| -e.by_rules.max(LEAST).ln()).sum::<f64>() / count;
    let provenance = Provenance {
        command: command.to_owned(),
        studies: studies.to_vec(),
        examples: labelled.len(),
        ridge: *ridge,
        log_loss: rounded(loss_of(predicted)),
        log_loss_of_shares: rounded(by_shares),
        log_loss_of_rules: rounded(by_rules),
    };
    let out_of_fold =
        alternatives.iter().zip(predicted).map(|(a, p)| OutOfFold(Weighed::new(a, p))).collect();
    Ok((verdict(&coefficients, &alternatives, shares, provenance), out_of_fold))
}

/// A probability that counts as this at least: rules tuned by hand may give none at all.
const LEAST: f64 = 1e-3;

fn alternatives(example: &Example) -> Alternatives {
    Alternatives::of(&example.evidence, example.rules_say(), |effect| example.excluded.contains(&effect))
}

fn choice(example: &Example, alternatives: &Alternatives) -> Choice {
    let known = |effect: &Effect| example.holds.effects.contains(effect);
    let mut holds: Vec<bool> = alternatives.effects.iter().map(known).collect();
    let is_lost = !example.holds.effects.is_empty() && !holds.contains(&true) && !example.holds.none;
    holds.push(example.holds.none);
    // A cause without a fit is none of those that have one.
    holds.push(example.holds.none_of_these || is_lost);
    Choice { alternatives: alternatives.rows(), holds }
}

fn signs() -> [Sign; COEFFICIENTS] {
    let mut signs = [Sign::Any; COEFFICIENTS];
    signs.iter_mut().zip(OF_EFFECT).for_each(|(sign, feature)| *sign = feature.sign);
    signs
}

fn shares(examples: &[Example]) -> Result<Shares, CalibrateError> {
    let known: Vec<&Holds> = examples.iter().map(|e| &e.holds).filter(|holds| !holds.is_unknown()).collect();
    let count = |is: &dyn Fn(&Holds) -> bool| known.iter().filter(|holds| is(holds)).count();
    let none = count(&|h| h.none);
    let foreign = count(&|h| h.none_of_these && !h.none);
    let effect = known.len() - none - foreign;
    for (kind, of) in [("a known fault", effect), ("no fault", none), ("a foreign fault", foreign)] {
        if of == 0 {
            return Err(CalibrateError::Missing(kind, known.len()));
        }
    }
    let share = |of: usize| rounded(of as f64 / known.len() as f64);
    Ok(Shares { effect: share(effect), none: share(none), none_of_these: share(foreign) })
}

/// What shares alone give to what holds, every effect alike.
fn share_of(choice: &Choice, shares: Shares) -> f64 {
    let effects = choice.holds.len().saturating_sub(2);
    let each = shares.effect / effects.max(1) as f64;
    let of = |(k, holds): (usize, &bool)| match k {
        _ if !*holds => 0.0,
        _ if k < effects => each,
        _ if k == effects => shares.none,
        _ => shares.none_of_these,
    };
    choice.holds.iter().enumerate().map(of).sum()
}

fn loss(choices: &[Choice], predicted: &[Vec<f64>]) -> f64 {
    let right = |(choice, p): (&Choice, &Vec<f64>)| -> f64 {
        choice.holds.iter().zip(p).filter(|(holds, _)| **holds).map(|(_, p)| p).sum()
    };
    let known = choices.iter().zip(predicted).filter(|(choice, _)| choice.holds.contains(&true));
    let losses: Vec<f64> = known.map(right).map(|p| -p.max(f64::MIN_POSITIVE).ln()).collect();
    losses.iter().sum::<f64>() / losses.len().max(1) as f64
}

/// The fold of each example, by base and by law.
struct Folds(Vec<(usize, Option<usize>)>);

impl Folds {
    fn of(examples: &[Example]) -> Result<Self, CalibrateError> {
        let mut bases: Vec<&str> = examples.iter().map(|e| e.base.as_str()).collect();
        let mut laws: Vec<&str> = examples.iter().filter_map(|e| e.law.as_deref()).collect();
        for names in [&mut bases, &mut laws] {
            names.sort_unstable();
            names.dedup();
        }
        if bases.len() < 2 || laws.len() < 2 {
            return Err(CalibrateError::TooFew(bases.len(), laws.len()));
        }
        let at = |names: &[&str], name: &str| {
            names.iter().position(|known| *known == name).unwrap_or_default() % FOLDS
        };
        let fold = |e: &Example| (at(&bases, &e.base), e.law.as_deref().map(|law| at(&laws, law)));
        Ok(Self(examples.iter().map(fold).collect()))
    }

    /// Probabilities of the alternatives of every example, by a fit to those that share neither fold with it.
    fn predicted(&self, choices: &[Choice], ridge: f64) -> Vec<Vec<f64>> {
        let mut predicted = vec![Vec::new(); choices.len()];
        let mut folds = self.0.clone();
        folds.sort_unstable();
        folds.dedup();
        for fold in folds {
            let apart =
                |other: &(usize, Option<usize>)| other.0 != fold.0 && (fold.1.is_none() || other.1 != fold.1);
            let known = self
                .0
                .iter()
                .zip(choices)
                .filter(|(other, choice)| apart(other) && choice.holds.contains(&true));
            let known: Vec<Choice> = known.map(|(_, choice)| choice.clone()).collect();
            let coefficients = fitted(&known, &signs(), ridge);
            for (k, choice) in choices.iter().enumerate().filter(|(k, _)| self.0[*k] == fold) {
                predicted[k] = probabilities(&coefficients, &choice.alternatives);
            }
        }
        predicted
    }
}

/// To six digits, as the file has it.
fn rounded(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}

fn verdict(
    coefficients: &[f64],
    alternatives: &[Alternatives],
    shares: Shares,
    provenance: Provenance,
) -> FittedVerdict {
    let range = |figures: Vec<f64>| {
        let low = figures.iter().copied().fold(f64::INFINITY, f64::min);
        [rounded(low), rounded(figures.iter().copied().fold(f64::NEG_INFINITY, f64::max))]
    };
    let of_effects = |k: usize| {
        range(alternatives.iter().flat_map(|a| a.of_effects()).map(|features| features[k]).collect())
    };
    let of_all = |k: usize| range(alternatives.iter().map(|a| a.of_all()[k]).collect());
    let one = |(feature, value, met): (&str, &f64, [f64; 2])| Coefficient {
        feature: feature.to_owned(),
        value: rounded(*value),
        met,
    };
    let (effect, rest) = coefficients.split_at(OF_EFFECT.len());
    let (none, none_of_these) = rest.split_at(OF_ALL.len());
    let whole = |values: &[f64]| {
        OF_ALL
            .iter()
            .zip(values)
            .enumerate()
            .map(|(k, (name, value))| one((name, value, of_all(k))))
            .collect()
    };
    let effect = OF_EFFECT.iter().zip(effect).enumerate();
    FittedVerdict {
        provenance,
        shares,
        agreed: Agreed::default(),
        effect: effect.map(|(k, (feature, value))| one((feature.name, value, of_effects(k)))).collect(),
        none: whole(none),
        none_of_these: whole(none_of_these),
    }
}

#[cfg(test)]
mod tests {
    use super::super::examples::rigs;
    use super::*;

    fn calibrated(examples: &[Example]) -> (FittedVerdict, Vec<OutOfFold>) {
        calibrate(examples, ("a test", &["made".to_owned()])).expect("examples of all kinds")
    }

    #[test]
    fn a_fitted_verdict_beats_shares_on_rigs_that_it_was_not_fitted_to() {
        let examples = rigs(240);
        let (verdict, predicted) = calibrated(&examples);
        let from = &verdict.provenance;
        assert!(from.log_loss < 0.7 * from.log_loss_of_shares, "{from:?}");
        assert!((from.log_loss_of_rules + 0.2_f64.ln()).abs() < 1e-5);
        let is_right = |(e, p): &(&Example, &OutOfFold)| e.holds.effects.first() == Some(&p.0.effects[0].0);
        let faults = || examples.iter().zip(&predicted).filter(|(e, _)| !e.holds.effects.is_empty());
        assert!(faults().filter(is_right).count() * 10 > 7 * faults().count());
        assert_eq!(verdict.shares, Shares { effect: 0.666_667, none: 0.166_667, none_of_these: 0.166_667 });
    }

    #[test]
    fn what_is_predicted_knows_neither_its_base_nor_its_law() {
        let examples = rigs(240);
        let folds = Folds::of(&examples).expect("several");
        let alternatives: Vec<Alternatives> = examples.iter().map(alternatives).collect();
        let choices: Vec<Choice> = examples.iter().zip(&alternatives).map(|(e, a)| choice(e, a)).collect();
        let before = folds.predicted(&choices, 1.0);
        // Other labels wherever base or law are those of the first.
        let (base, law) = (&examples[0].base, &examples[0].law);
        let mut changed = choices.clone();
        for (choice, example) in changed.iter_mut().zip(&examples) {
            if example.base == *base || example.law == *law {
                choice.holds.rotate_left(1);
            }
        }
        let after = folds.predicted(&changed, 1.0);
        assert_eq!(before[0], after[0]);
        assert!(before.iter().zip(&after).any(|(x, y)| x != y));
    }

    #[test]
    fn examples_that_nobody_knows_the_cause_of_are_predicted_and_fitted_to_nothing() {
        let examples = rigs(240);
        let mut more = examples.clone();
        more.push(Example { holds: Holds::default(), ..examples[3].clone() });
        let (known, _) = calibrated(&examples);
        let (with_unknown, predicted) = calibrated(&more);
        assert_eq!(
            known.effect.iter().map(|c| c.value).collect::<Vec<_>>(),
            with_unknown.effect.iter().map(|c| c.value).collect::<Vec<_>>()
        );
        assert_eq!(known.provenance, with_unknown.provenance);
        assert_eq!(predicted.len(), 241);
    }

    #[test]
    fn a_kind_that_is_missing_is_reported() {
        let mut examples = rigs(60);
        examples.retain(|e| !e.holds.none_of_these);
        let refused = calibrate(&examples, ("", &[])).expect_err("no foreign fault");
        assert_eq!(refused, CalibrateError::Missing("a foreign fault", 50));
        let mut alone = rigs(60);
        alone.iter_mut().for_each(|e| e.base = "one".to_owned());
        assert_eq!(calibrate(&alone, ("", &[])).expect_err("one base"), CalibrateError::TooFew(1, 3));
    }

    #[test]
    fn the_file_is_read_back_and_shares_move_the_odds() {
        let examples = rigs(120);
        let (verdict, _) = calibrated(&examples);
        let text = serde_json::to_string(&verdict).expect("numbers");
        let read: FittedVerdict = serde_json::from_str(&text).expect("as it was written");
        assert_eq!(read, verdict);
        let renamed = text.replacen("\"settling\"", "\"setling\"", 1);
        assert!(serde_json::from_str::<FittedVerdict>(&renamed).is_err());
        let evidence = &examples[0].evidence;
        let rules = examples[0].rules_say();
        let alternatives = |evidence: &[Compared]| Alternatives::of(evidence, rules, |_| false);
        let before = verdict.weigh(&alternatives(evidence));
        let rare = Shares { effect: 0.1, none: 0.8, none_of_these: 0.1 };
        let after = verdict.clone().with_shares(rare).weigh(&alternatives(evidence));
        let odds = |w: &Weighed| w.effects[0].1 / w.none;
        let factor = (rare.effect / verdict.shares.effect) / (rare.none / verdict.shares.none);
        assert!((odds(&after) / odds(&before) / factor - 1.0).abs() < 1e-9);
        assert!(before.is_met);
        let mut strange = examples[0].evidence.clone();
        strange[0].left_by_best = 1e9;
        strange[0].effects.iter_mut().for_each(|e| e.delta_bic = 1e9);
        assert!(!verdict.weigh(&alternatives(&strange)).is_met);
    }
}
