//! Records that nobody designed: the posterior decides, and its likeliest effects are fitted.

use super::analyses::Analysis;
use super::plan::Plan;
use super::report::Conclusion;
use crate::attribution::explain::Hypothesis;
use crate::diagnosis::Diagnosis;
use crate::error::DiagnoseError;
use crate::evidence::Judged;
use crate::nominal::order::{Choice, structure};
use crate::phase::Phase;
use crate::posterior::{Classification, Posterior};
use crate::records::dataset::Dataset;
use crate::residuals::omnibus::omnibus;
use crate::settings::{Model, Settings};
use crate::verdict::answer::{Status, Verdict};
use crate::verdict::decide::held_out_differs;
use crate::verdict::odds::Odds;
use crate::workers::Workers;
use switchback_model::rig::Rig;

/// A rig unlike those that the posterior was trained on.
pub(super) const OUTSIDE: &str = "the records are unlike those that the posterior was trained on: farther from these than 99 of 100 rigs that were held out; its \
                                  probabilities only rank, and nothing is named";

/// What a posterior says of a rig by itself, where it may decide.
pub(super) fn classification(
    rig: &Rig,
    (records, settings): (&Dataset, &Settings),
    posterior: &Posterior,
) -> Result<Option<Classification>, DiagnoseError> {
    let is_asked = settings.asked.iter().any(|effect| effect.card().colours_noise);
    if rig.order.is_some() || records.is_designed() || is_asked {
        return Ok(None);
    }
    let Ok(Some(judged)) = Judged::identified(rig) else { return Ok(None) };
    Ok(Some(Classification::of(&judged, posterior, settings)?))
}

/// The diagnosis of a rig by itself; none where its records show no nominal system, or one that leaves nothing.
pub(super) fn classified(
    workers: &impl Workers,
    rig: &Rig,
    (records, settings): (&Dataset, &Settings),
    posterior: &Posterior,
) -> Result<Option<Diagnosis>, DiagnoseError> {
    let Some(classification) = classification(rig, (records, settings), posterior)? else { return Ok(None) };
    let head = classification.head(settings);
    let chosen = match structure(workers, (rig, records.clone()), None, settings)? {
        Choice::One(chosen) => chosen,
        // What changes only the noise moves no simulation.
        Choice::Either(steps, _) if head.first().is_some_and(|first| first.moves_no_simulation()) => steps,
        Choice::Either(_, simulator) => simulator.chosen(),
    };
    let mut plan = Plan::new(rig, &Model::Identify, settings, chosen)?;
    if plan.nothing_to_explain().is_some() {
        return Ok(None);
    }
    plan.settings.effects.retain(|effect| head.contains(effect));
    if classification.is_outside() {
        plan.limitations.push(OUTSIDE.to_owned());
    }
    let singles = plan.singles(workers);
    let conclusion = plan.concluded(singles, &classification);
    workers.begin(Phase::Report);
    let says = plan.compared(workers, &conclusion);
    let analysis = Analysis { plan, conclusion };
    let weighed: Vec<(&Hypothesis, f64)> =
        analysis.conclusion.singles.iter().zip(analysis.conclusion.odds.effects.iter().copied()).collect();
    let mut candidates = analysis.candidates(workers, &weighed, &says);
    candidates.sort_by(|x, y| y.probability.total_cmp(&x.probability));
    let Analysis { plan, conclusion } = analysis;
    let diagnosis = plan.report(conclusion, candidates, vec![says]);
    Ok(Some(Diagnosis { classification: Some(classification), ..diagnosis }))
}

impl Plan {
    /// What the posterior says, shown by the fit of the effect that comes first.
    fn concluded(&self, singles: Vec<Hypothesis>, classification: &Classification) -> Conclusion {
        let probability = |s: &Hypothesis| classification.probability(s.effect_terms[0].effect);
        let odds = Odds {
            effects: singles.iter().map(probability).collect(),
            none: classification.none,
            unexplained: classification.unexplained(),
        };
        let nominal = &self.nominal.plain;
        let mut verdict = classification.verdict();
        if verdict.status == Status::None
            && let Some(ratio) = self.held_out_errors_beyond_chance(&nominal.fit)
        {
            let calibrated = verdict.calibrated;
            verdict = Verdict { calibrated, ..held_out_differs(&odds, ratio) };
        }
        let first = verdict.effects.first().or(verdict.class.first());
        let shown = first.and_then(|first| singles.iter().find(|s| s.effect_terms[0].effect == *first));
        let augmented = shown.unwrap_or(nominal).clone();
        let samples = self.dataset.fit_samples();
        let left = omnibus(&self.dataset, &augmented.fit).map_or(0.0, |tests| tests.against(samples));
        Conclusion {
            fitted: singles.clone(),
            singles,
            odds,
            verdict,
            augmented,
            left,
            together: None,
            other: None,
        }
    }
}
