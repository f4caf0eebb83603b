//! The diagnosis of the model identified from a rig's own records.

use switchback_model::rig::Rig;

use super::analyses::Analysis;
use super::plan::Plan;
use super::refit;
use super::rig_evidence::RigEvidence;
use crate::attribution::PairEffort;
use crate::diagnosis::Diagnosis;
use crate::effect::Effect;
use crate::error::DiagnoseError;
use crate::nominal::order::{Choice, Chosen, declared, of_structure, structure};
use crate::phase::Phase;
use crate::records::dataset::Dataset;
use crate::settings::{Model, Settings};
use crate::verdict::answer::Status;
use crate::workers::Workers;

/// The structure of a model, the likeliest effects fitted with it, the verdict.
pub(super) fn of_own_model(
    workers: &impl Workers,
    rig: &Rig,
    settings: &Settings,
) -> Result<Diagnosis, DiagnoseError> {
    workers.begin(Phase::Nominal);
    let records = Dataset::new(rig)?;
    let declared = declared(rig, &Model::Identify)?;
    let settings =
        &with_colour_where_the_structure_is_known(settings, declared.is_some() || records.is_designed());
    let evidence = &RigEvidence::new(rig, settings);
    let choice = structure(workers, (rig, records.clone()), declared, settings)?;
    let plan = |chosen: Chosen| Plan::new(rig, &Model::Identify, settings, chosen);
    let mut analysis = analysed(workers, choice, &plan, evidence)?;
    if declared.is_none() && records.is_designed() {
        analysis = with_room_for_dynamics(workers, analysis, (&records, &plan), evidence)?;
    }
    Ok(analysis.report(workers))
}

/// Of records that nobody designed the colour of the noise belongs to the model; where the structure of the model is known it is a cause.
fn with_colour_where_the_structure_is_known(settings: &Settings, is_known: bool) -> Settings {
    let colour: Vec<Effect> =
        Effect::ALL.into_iter().filter(|e| is_known && e.card().colours_noise).collect();
    settings.clone().asking(&colour)
}

/// The analysis of one choice; of two the one that simulates better.
fn analysed(
    workers: &impl Workers,
    choice: Choice,
    plan: &impl Fn(Chosen) -> Result<Plan, DiagnoseError>,
    evidence: &RigEvidence<'_>,
) -> Result<Analysis, DiagnoseError> {
    let (mut steps, simulator) = match choice {
        Choice::One(chosen) => return Analysis::run(workers, plan(chosen)?, evidence),
        Choice::Either(steps, simulator) => (plan(steps)?, plan(simulator.chosen())?),
    };
    if steps.weighs_likelihoods() {
        steps.pair_effort = PairEffort::WhileHopeful;
    }
    let steps = Analysis::run(workers, steps, evidence)?;
    // What changes only the noise moves no simulation.
    let moves_none = |(effect, _): &(Effect, f64)| effect.moves_no_simulation();
    if steps.has_nothing_to_explain() || evidence.classification()?.effects().first().is_some_and(moves_none)
    {
        return Ok(steps);
    }
    let runs = Analysis::run(workers, simulator, evidence)?;
    Ok(if runs.has_nothing_to_explain() || runs.error() <= steps.error() { runs } else { steps })
}

/// The analysis on a nominal model with room for the machine's own dynamics, where one of those, or a delay, would be reported and a higher
/// order or another delay does the same on the held-out records. Its verdict counts, unless it is such an effect again, or
/// nothing of use: then the order is the answer.
fn with_room_for_dynamics(
    workers: &impl Workers,
    first: Analysis,
    (records, plan): (&Dataset, &impl Fn(Chosen) -> Result<Plan, DiagnoseError>),
    evidence: &RigEvidence<'_>,
) -> Result<Analysis, DiagnoseError> {
    if !refit::shows_dynamics(&first.conclusion.verdict) {
        return Ok(first);
    }
    let simulates = first.plan.dataset.criterion.simulates();
    let wider = first.plan.structure.wider(refit::shows_a_delay(&first.conclusion.verdict));
    let fitted = workers.map(&wider, |structure| of_structure(records, *structure, simulates).ok());
    let Some(chosen) = fitted.into_iter().flatten().find(|chosen| first.does_the_same(chosen)) else {
        return Ok(first);
    };
    let again = Analysis::run(workers, plan(chosen)?, evidence)?;
    let verdict = &again.conclusion.verdict;
    if refit::shows_dynamics(verdict) || verdict.status == Status::Unexplained {
        let conclusion = first.plan.refitted(first.conclusion, &again.plan);
        return Ok(Analysis { conclusion, ..first });
    }
    Ok(again)
}
