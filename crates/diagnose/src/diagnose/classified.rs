//! Records that nobody designed: the posterior decides, and its likeliest effects are fitted.

use super::analyses::Analysis;
use super::plan::Plan;
use super::report::Conclusion;
use crate::attribution::explain::Hypothesis;
use crate::diagnosis::Diagnosis;
use crate::effect::Effect;
use crate::error::DiagnoseError;
use crate::evidence::Judged;
use crate::nominal::order::{Choice, structure};
use crate::posterior::{Classification, LeadingFit};
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

/// What evidence says of a rig by itself, where a posterior decides.
fn classification(
    rig: &Rig,
    (records, settings): (&Dataset, &Settings),
) -> Result<Option<Classification>, DiagnoseError> {
    let is_asked = settings.asked.iter().any(|effect| effect.card().colours_noise);
    if rig.order.is_some() || records.is_designed() || is_asked {
        return Ok(None);
    }
    let Ok(Some(judged)) = Judged::identified(rig) else { return Ok(None) };
    Ok(Some(Classification::of(&judged, settings)?))
}

/// The diagnosis of a rig by itself; none where its records show no nominal system, or one that leaves nothing.
pub(super) fn classified(
    workers: &impl Workers,
    rig: &Rig,
    (records, settings): (&Dataset, &Settings),
) -> Result<Option<Diagnosis>, DiagnoseError> {
    let Some(classification) = classification(rig, (records, settings))? else { return Ok(None) };
    let chosen = match structure(workers, (rig, records.clone()), None, settings)? {
        Choice::One(chosen) => vec![chosen],
        Choice::Either(steps, simulator) => vec![simulator.chosen(), steps],
    };
    let plan = |chosen| Plan::new(rig, &Model::Identify, settings, chosen);
    let plans = chosen.into_iter().map(plan).collect::<Result<Vec<Plan>, _>>()?;
    if plans.iter().any(|plan| plan.nothing_to_explain().is_some()) {
        return Ok(None);
    }
    let fitted = plans.into_iter().map(|plan| Fitted::new(workers, plan, &classification));
    let Some(Fitted { plan, singles, leading, .. }) = Fitted::best(fitted.collect(), &classification) else {
        return Ok(None);
    };
    let classification = classification.joined_by(leading);
    let conclusion = plan.concluded(singles, &classification);
    let says = plan.compared(workers, &conclusion);
    let analysis = Analysis { plan, conclusion };
    let candidates = analysis.all_candidates(workers, &says);
    let Analysis { plan, conclusion } = analysis;
    let diagnosis = plan.report(conclusion, candidates, Some(says));
    Ok(Some(Diagnosis { classification: Some(classification), ..diagnosis }))
}

/// The likeliest effects, fitted with one nominal model.
struct Fitted {
    plan: Plan,
    singles: Vec<Hypothesis>,
    leading: Option<LeadingFit>,
}

impl Fitted {
    fn new(workers: &impl Workers, mut plan: Plan, classification: &Classification) -> Self {
        let head = classification.head(&plan.settings);
        // An effect may be found beside one with which it is confounded, or beside the colour of the noise, which belongs to the model.
        let is_beside = |effect: &Effect| {
            effect.card().colours_noise || head.iter().any(|e| e.confounded_effects().contains(effect))
        };
        plan.settings.effects.retain(|effect| head.contains(effect) || is_beside(effect));
        if classification.is_outside() {
            plan.limitations.push(OUTSIDE.to_owned());
        }
        let mut singles = plan.gather(workers).all;
        singles.retain(|single| classification.probability(single.effect_terms[0].effect) > 0.0);
        let by_evidence = plan.concluded(singles, classification);
        let leading = classification.leading_fit(&plan.compared(workers, &by_evidence));
        Self { plan, singles: by_evidence.singles, leading }
    }

    /// Of simulators and predictions one step ahead those that simulate the judged records better; the latter where the likeliest effect changes only the
    /// noise, which moves no simulation.
    fn best(mut fitted: Vec<Self>, classification: &Classification) -> Option<Self> {
        if classification.effects().first().is_some_and(|(first, _)| first.moves_no_simulation()) {
            return fitted.pop();
        }
        fitted.into_iter().min_by(|x, y| x.error().total_cmp(&y.error()))
    }

    /// Error of the simulation of the judged records with the effect that leads, if one does.
    fn error(&self) -> f64 {
        let leads = |single: &&Hypothesis| {
            self.leading.is_some_and(|leading| leading.effect == single.effect_terms[0].effect)
        };
        let shown = self.singles.iter().find(leads).unwrap_or(&self.plan.nominal.plain);
        self.plan.simulation_error(&shown.fit)
    }
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
        // Of a list the first whose repair makes no held-out record worse beyond its error.
        let listed = verdict.effects.iter().chain(&verdict.class);
        let fits = listed.filter_map(|effect| singles.iter().find(|s| s.effect_terms[0].effect == *effect));
        let is_named = verdict.status == Status::Named;
        let shown = fits.into_iter().find(|s| is_named || !self.degrades_validation(s));
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
