//! The comparisons of candidates, and the final report of every effect.

use super::parameters::parameters;
use super::plan::Plan;
use super::report::Conclusion;
use crate::attribution::explain::Hypothesis;
use crate::attribution::search::profiled;
use crate::comparison::{Compared, EffectEvidence};
use crate::diagnosis::{Candidate, Diagnosis};
use crate::effect::Effect;
use crate::nominal::order::Chosen;
use crate::phase::Phase;
use crate::verdict::answer::Status;
use crate::verdict::fitted::{FittedVerdict, SecondOpinion};
use crate::workers::Workers;

/// One comparison of candidates, and what it concludes.
pub(super) struct Analysis {
    pub(super) plan: Plan,
    pub(super) conclusion: Conclusion,
}

impl Analysis {
    /// Runs an analysis.
    pub(super) fn run(workers: &impl Workers, mut plan: Plan) -> Self {
        let conclusion = plan.attribute(workers);
        Self { plan, conclusion }
    }

    /// Whether a nominal model of another structure does on the judged records what the augmented model does.
    pub(super) fn does_the_same(&self, chosen: &Chosen) -> bool {
        self.plan.does_the_same(chosen, &self.conclusion.augmented.fit)
    }
}

/// All analyses, with what each says of every effect.
pub(super) struct Analyses {
    /// That of the verdict.
    reported: Analysis,
    evidence: Compared,
    others: Vec<(Analysis, Compared)>,
}

impl Analyses {
    /// Asks each analysis about every effect.
    pub(super) fn new(workers: &impl Workers, reported: Analysis, others: Vec<Analysis>) -> Self {
        workers.begin(Phase::Report);
        let asked = |analysis: &Analysis| analysis.plan.compared(workers, &analysis.conclusion);
        let evidence = asked(&reported);
        let others = others
            .into_iter()
            .map(|analysis| (asked(&analysis), analysis))
            .map(|(says, analysis)| (analysis, says))
            .collect();
        Self { reported, evidence, others }
    }

    /// The diagnosis that is handed out.
    pub(super) fn report(mut self, workers: &impl Workers) -> Diagnosis {
        let second_opinion = self.second_opinion();
        if let Some(opinion) = &second_opinion {
            self.describe(opinion);
        }
        let weights = second_opinion.as_ref().map(SecondOpinion::weights);
        let candidates = match &weights {
            Some((effects, _)) => self.candidates_of(workers, effects.clone()),
            None => self.candidates(workers),
        };
        let Self { reported: Analysis { plan, conclusion }, evidence, others } = self;
        let evidence = std::iter::once(evidence).chain(others.into_iter().map(|(_, says)| says));
        let diagnosis = plan.report(conclusion, candidates, evidence.collect());
        match weights {
            Some((_, [probability_none, probability_unexplained])) => {
                Diagnosis { probability_none, probability_unexplained, second_opinion, ..diagnosis }
            }
            None => diagnosis,
        }
    }

    /// What a verdict that was fitted says of the same evidence, where the records are as the field has them: it was fitted to no others.
    fn second_opinion(&self) -> Option<SecondOpinion> {
        let Analysis { plan, conclusion } = &self.reported;
        let compared: Vec<Compared> = self.all().map(|(_, says)| says.clone()).collect();
        let says_something = compared.iter().any(|says| !says.effects.is_empty());
        if !says_something || !self.all().any(|(analysis, _)| analysis.plan.is_of_the_field()) {
            return None;
        }
        let fitted = match plan.settings.prior {
            Some(prior) => &FittedVerdict::built_in().clone().with_shares(prior),
            None => FittedVerdict::built_in(),
        };
        let by_rules = (conclusion.verdict.clone(), conclusion.likeliest());
        Some(fitted.opinion(&compared, |effect| self.is_no_cause(effect), by_rules, plan.settings.name_at))
    }

    /// Shows what the fitted verdict says, by the analysis that simulates best with the first effect reported.
    fn describe(&mut self, opinion: &SecondOpinion) {
        let verdict = opinion.reported(self.reported.plan.settings.name_at);
        let is_by_rules =
            !verdict.effects.is_empty() && verdict.effects == self.reported.conclusion.verdict.effects;
        if !is_by_rules {
            match verdict.effects.first().or(verdict.class.first()) {
                Some(&first) => self.describe_of(first),
                None if verdict.status == Status::None => {
                    self.reported.conclusion.augmented = self.reported.plan.nominal.plain.clone();
                }
                None => {}
            }
        }
        self.reported.conclusion.verdict = verdict;
    }

    /// Puts the analysis first that simulates the judged records best with an effect, of those in which it degrades no record, if there are any.
    fn describe_of(&mut self, effect: Effect) {
        let fitted = |analysis: &Analysis| {
            analysis.conclusion.fitted.iter().find(|s| s.effect_terms[0].effect == effect).cloned()
        };
        let found = self.all().enumerate().filter_map(|(k, (analysis, says))| {
            let single = fitted(analysis)?;
            let error = analysis.plan.simulation_error(&single.fit);
            Some((says.degrades_validation(effect) == Some(true), error, k, single))
        });
        let best = found.min_by(|x, y| x.0.cmp(&y.0).then(x.1.total_cmp(&y.1)));
        let Some((.., place, single)) = best else { return };
        if place > 0 {
            let (analysis, says) = &mut self.others[place - 1];
            std::mem::swap(&mut self.reported, analysis);
            std::mem::swap(&mut self.evidence, says);
        }
        let conclusion = &mut self.reported.conclusion;
        (conclusion.augmented, conclusion.other) = (single, None);
    }

    /// Whether an effect belongs to the model of records that nobody designed, or was left out.
    fn is_no_cause(&self, effect: Effect) -> bool {
        effect.card().colours_noise || self.reported.plan.settings.is_left_out(effect)
    }

    /// All analyses with what they say, that of the verdict first.
    fn all(&self) -> impl Iterator<Item = (&Analysis, &Compared)> {
        std::iter::once((&self.reported, &self.evidence))
            .chain(self.others.iter().map(|(analysis, says)| (analysis, says)))
    }

    /// The effects that have a probability by rules, the likeliest first.
    fn candidates(&self, workers: &impl Workers) -> Vec<Candidate> {
        let Conclusion { singles, odds, .. } = &self.reported.conclusion;
        let weighed: Vec<(&Hypothesis, f64)> = singles.iter().zip(odds.effects.iter().copied()).collect();
        let mut candidates = self.reported.candidates(workers, &weighed, &self.evidence);
        candidates.sort_by(|x, y| {
            y.probability.total_cmp(&x.probability).then(y.delta_bic.total_cmp(&x.delta_bic))
        });
        candidates
    }

    /// The effects given with their probabilities, the likeliest first: each as the first way that fitted it has it.
    fn candidates_of(&self, workers: &impl Workers, mut left: Vec<(Effect, f64)>) -> Vec<Candidate> {
        let mut candidates = Vec::new();
        for (analysis, says) in self.all() {
            let of = |(effect, p): &(Effect, f64)| {
                let single =
                    analysis.conclusion.fitted.iter().find(|s| s.effect_terms[0].effect == *effect)?;
                Some((single, *p))
            };
            let known: Vec<(&Hypothesis, f64)> = left.iter().filter_map(of).collect();
            left.retain(|asked| of(asked).is_none());
            candidates.extend(analysis.candidates(workers, &known, says));
        }
        candidates.sort_by(|x, y| y.probability.total_cmp(&x.probability));
        candidates
    }
}

impl Analysis {
    /// Hypotheses of one effect as candidates with a probability; those that the verdict shows with profiled intervals.
    pub(super) fn candidates(
        &self,
        workers: &impl Workers,
        weighed: &[(&Hypothesis, f64)],
        says: &Compared,
    ) -> Vec<Candidate> {
        let (dataset, verdict) = (&self.plan.dataset, &self.conclusion.verdict);
        let is_reported = |effect| verdict.effects.contains(&effect) || verdict.class.contains(&effect);
        let one = |&(single, p): &(&Hypothesis, f64)| {
            let effect = single.effect_terms[0].effect;
            let says = says.of(effect)?;
            let intervals = match is_reported(effect) {
                true => profiled(workers, dataset, single),
                false => single.fit.intervals(),
            };
            let parameters = parameters(dataset, (single, 0), &intervals);
            Some(Candidate { parameters, ..candidate((single, p), says) })
        };
        workers.map(weighed, one).into_iter().flatten().collect()
    }
}

/// A candidate with its probability, its parameters left out.
fn candidate((single, probability): (&Hypothesis, f64), says: &EffectEvidence) -> Candidate {
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
