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

    /// The diagnosis that is handed out.
    pub(super) fn report(self, workers: &impl Workers) -> Diagnosis {
        workers.begin(Phase::Report);
        let says = self.plan.compared(workers, &self.conclusion);
        let candidates = self.all_candidates(workers, &says);
        self.plan.report(self.conclusion, candidates, Some(says))
    }

    /// The effects that have a probability, the likeliest first.
    pub(super) fn all_candidates(&self, workers: &impl Workers, says: &Compared) -> Vec<Candidate> {
        let Conclusion { singles, odds, .. } = &self.conclusion;
        let weighed: Vec<(&Hypothesis, f64)> = singles.iter().zip(odds.effects.iter().copied()).collect();
        let mut candidates = self.candidates(workers, &weighed, says);
        candidates.sort_by(|x, y| {
            y.probability.total_cmp(&x.probability).then(y.delta_bic.total_cmp(&x.delta_bic))
        });
        candidates
    }

    /// Whether a nominal model of another structure does on the judged records what the augmented model does.
    pub(super) fn does_the_same(&self, chosen: &Chosen) -> bool {
        self.plan.does_the_same(chosen, &self.conclusion.augmented.fit)
    }
}

impl Analysis {
    /// Hypotheses of one effect as candidates with a probability; those that the verdict shows with profiled intervals.
    fn candidates(
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
