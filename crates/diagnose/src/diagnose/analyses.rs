//! The comparisons of candidates, and the final report of every effect.

use super::parameters::parameters;
use super::plan::{Plan, lacks};
use super::report::Conclusion;
use super::rig_evidence::RigEvidence;
use crate::attribution::explain::Hypothesis;
use crate::attribution::search::profiled;
use crate::comparison::{Compared, EffectEvidence};
use crate::diagnosis::{Candidate, Diagnosis};
use crate::effect::Effect;
use crate::error::DiagnoseError;
use crate::nominal::order::Chosen;
use crate::phase::Phase;
use crate::posterior::Classification;
use crate::workers::Workers;

/// One nominal model with the likeliest effects, and what follows.
pub(super) struct Analysis {
    pub(super) plan: Plan,
    pub(super) conclusion: Conclusion,
    /// The probabilities joined by the fits; none where nothing is left to explain.
    pub(super) classification: Option<Classification>,
}

impl Analysis {
    /// Fits effects and draws the conclusion.
    ///
    /// # Errors
    /// [`DiagnoseError`] where the posterior was trained with other columns.
    pub(super) fn run(
        workers: &impl Workers,
        mut plan: Plan,
        evidence: &RigEvidence<'_>,
    ) -> Result<Self, DiagnoseError> {
        if let Some(conclusion) = plan.nothing_to_explain() {
            return Ok(Self { plan, conclusion, classification: None });
        }
        let (conclusion, classification) = plan.attribute(workers, evidence)?;
        plan.limitations.extend(lacks(&classification));
        Ok(Self { plan, conclusion, classification: Some(classification) })
    }

    pub(super) fn has_nothing_to_explain(&self) -> bool {
        self.classification.is_none()
    }

    /// Error of the simulation of the judged records with the effect whose fit leads, if one does.
    pub(super) fn error(&self) -> f64 {
        let leads = self.classification.as_ref().and_then(Classification::confirmed);
        let shown = |s: &&Hypothesis| leads == Some(s.effect_terms[0].effect);
        let shown = self.conclusion.singles.iter().find(shown).unwrap_or(&self.plan.nominal.plain);
        self.plan.simulation_error(&shown.fit)
    }

    /// The diagnosis that is handed out.
    pub(super) fn report(self, workers: &impl Workers) -> Diagnosis {
        workers.begin(Phase::Report);
        let says = self.plan.compared(workers, &self.conclusion);
        let candidates = self.all_candidates(workers, &says);
        let classification = self.classification;
        Diagnosis { classification, ..self.plan.report(self.conclusion, candidates, Some(says)) }
    }

    /// The effects that have a probability, the likeliest first.
    fn all_candidates(&self, workers: &impl Workers, says: &Compared) -> Vec<Candidate> {
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
