//! The ways in which explanations were compared, and what is told of every effect in the end.

use super::Plan;
use super::parameters::parameters;
use super::report::Conclusion;
use crate::attribution::explain::Explanation;
use crate::attribution::search::profiled;
use crate::diagnosis::{Candidate, Diagnosis, Status, Verdict};
use crate::effect::Effect;
use crate::evidence::{Compared, EffectEvidence};
use crate::nominal::order::Chosen;
use crate::phase::Phase;
use crate::verdict::agreement::agreed;
use crate::verdict::fitted::{FittedVerdict, SecondOpinion};
use crate::workers::Workers;

/// One way of comparing explanations, and what it concludes.
pub(super) struct Way {
    pub(super) plan: Plan,
    pub(super) conclusion: Conclusion,
}

impl Way {
    /// Goes a way.
    pub(super) fn gone(workers: &impl Workers, mut plan: Plan) -> Self {
        let conclusion = plan.attribute(workers);
        Self { plan, conclusion }
    }

    /// Whether it tells a cause.
    pub(super) fn tells_a_cause(&self) -> bool {
        matches!(self.conclusion.verdict.status, Status::Named | Status::Class | Status::Ambiguous)
    }

    /// Whether a nominal model of another structure does on the judged records what the augmented model does.
    pub(super) fn does_the_same(&self, chosen: &Chosen) -> bool {
        self.plan.does_the_same(chosen, &self.conclusion.augmented.fit)
    }

    /// Whether it tells rivals among which another way names one.
    pub(super) fn leaves_open(&self, other: &Self) -> bool {
        let (rivals, named) = (&self.conclusion.verdict.class, &other.conclusion.verdict);
        named.status == Status::Named && matches!(named.effects[..], [only] if rivals.contains(&only))
    }

    /// Whether the augmented model of another way does better on the judged records.
    pub(super) fn is_outdone_by(&self, other: &Self) -> bool {
        let anew = (&other.plan.campaign, &other.conclusion.augmented.fit);
        self.plan.is_outdone_by(anew, &self.conclusion.augmented.fit)
    }
}

/// All ways that were gone, with what each says of every effect.
pub(super) struct Ways {
    /// That of the verdict.
    told: Way,
    evidence: Compared,
    others: Vec<(Way, Compared)>,
}

impl Ways {
    /// Asks each way about every effect.
    pub(super) fn new(workers: &impl Workers, told: Way, others: Vec<Way>) -> Self {
        workers.begin(Phase::Report);
        let asked = |way: &Way| way.plan.compared(workers, &way.conclusion);
        let evidence = asked(&told);
        let others =
            others.into_iter().map(|way| (asked(&way), way)).map(|(says, way)| (way, says)).collect();
        Self { told, evidence, others }
    }

    /// The diagnosis that is handed out.
    pub(super) fn report(mut self, workers: &impl Workers) -> Diagnosis {
        let second_opinion = self.second_opinion();
        if let Some(opinion) = &second_opinion {
            self.told.conclusion.verdict = self.agreed(opinion);
        }
        let candidates = self.candidates(workers);
        let evidence = std::iter::once(self.evidence).chain(self.others.into_iter().map(|(_, says)| says));
        let Way { plan, conclusion } = self.told;
        Diagnosis { second_opinion, ..plan.report(conclusion, candidates, evidence.collect()) }
    }

    /// What a verdict that was fitted says of the same evidence, where the records are as the field has them: it was fitted to no others.
    fn second_opinion(&self) -> Option<SecondOpinion> {
        let settings = &self.told.plan.settings;
        if !self.all().any(|(way, _)| way.plan.is_of_the_field()) {
            return None;
        }
        let fitted = match settings.prior {
            Some(prior) => &FittedVerdict::built_in().clone().with_shares(prior),
            None => FittedVerdict::built_in(),
        };
        let verdict = self.told.conclusion.verdict.clone();
        Some(fitted.opinion(&self.compared(), |effect| self.is_no_cause(effect), (settings.name_at, verdict)))
    }

    /// The verdict, where the other readings of the records put the same cause first.
    fn agreed(&self, opinion: &SecondOpinion) -> Verdict {
        let likeliest = opinion.effects.first().map(|(effect, ..)| *effect);
        agreed(opinion.by_rules.clone(), &self.compared(), likeliest, |effect| self.is_no_cause(effect))
    }

    /// What each way says.
    fn compared(&self) -> Vec<Compared> {
        self.all().map(|(_, says)| says.clone()).collect()
    }

    /// Whether an effect belongs to the model of records that nobody designed, or was left out.
    fn is_no_cause(&self, effect: Effect) -> bool {
        effect.card().colours_noise || self.told.plan.settings.is_left_out(effect)
    }

    /// All ways with what they say, that of the verdict first.
    fn all(&self) -> impl Iterator<Item = (&Way, &Compared)> {
        std::iter::once((&self.told, &self.evidence)).chain(self.others.iter().map(|(way, says)| (way, says)))
    }

    /// The effects that have a probability, the likeliest first.
    fn candidates(&self, workers: &impl Workers) -> Vec<Candidate> {
        let Conclusion { singles, odds, verdict, .. } = &self.told.conclusion;
        let campaign = &self.told.plan.campaign;
        let is_told = |effect| verdict.effects.contains(&effect) || verdict.class.contains(&effect);
        let weighed: Vec<(&Explanation, &f64)> = singles.iter().zip(&odds.effects).collect();
        let one = |(single, p): &(&Explanation, &f64)| {
            let effect = single.parts[0].effect;
            let says = self.evidence.of(effect)?;
            let intervals = match is_told(effect) {
                true => profiled(workers, campaign, single),
                false => single.fit.intervals(),
            };
            let parameters = parameters(campaign, (single, 0), &intervals);
            Some(Candidate { parameters, ..candidate((single, **p), says) })
        };
        let mut candidates: Vec<Candidate> = workers.map(&weighed, one).into_iter().flatten().collect();
        candidates.sort_by(|x, y| {
            y.probability.total_cmp(&x.probability).then(y.delta_bic.total_cmp(&x.delta_bic))
        });
        candidates
    }
}

/// A candidate with its probability, its parameters left out.
fn candidate((single, probability): (&Explanation, f64), says: &EffectEvidence) -> Candidate {
    let effect: Effect = says.effect;
    Candidate {
        effect,
        stage: effect.stage(),
        probability,
        parameters: Vec::new(),
        bic: single.bic(),
        delta_bic: says.delta_bic,
        heldout_log_score: says.heldout_log_score,
        gains: says.gains.clone(),
        closure: says.closure,
        unstable: says.unstable,
    }
}
