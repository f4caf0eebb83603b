//! The diagnosis of the model identified from a rig's own records.

use switchback_model::rig::Rig;

use super::analyses::Analysis;
use super::plan::Plan;
use super::{classified, refit};
use crate::attribution::PairEffort;
use crate::diagnosis::Diagnosis;
use crate::error::DiagnoseError;
use crate::nominal::order::{Choice, Chosen, declared, of_structure, structure};
use crate::phase::Phase;
use crate::records::dataset::Dataset;
use crate::settings::{Model, Settings};
use crate::verdict::answer::Status;
use crate::workers::Workers;

/// By the posterior where nobody designed the records and no order is declared, else by rules.
pub(super) fn of_own_model(
    workers: &impl Workers,
    rig: &Rig,
    settings: &Settings,
) -> Result<Diagnosis, DiagnoseError> {
    workers.begin(Phase::Nominal);
    let records = Dataset::new(rig)?;
    let declared = declared(rig, &Model::Identify)?;
    match classified::classified(workers, rig, (&records, settings))? {
        Some(diagnosis) => Ok(diagnosis),
        None => by_rules(workers, rig, (&records, settings), declared),
    }
}

/// The diagnosis by fits of every effect and by rules.
fn by_rules(
    workers: &impl Workers,
    rig: &Rig,
    (records, settings): (&Dataset, &Settings),
    declared: Option<usize>,
) -> Result<Diagnosis, DiagnoseError> {
    let plan = |chosen: Chosen| Plan::new(rig, &Model::Identify, settings, chosen);
    let chosen = structure(workers, (rig, records.clone()), declared, settings)?;
    let mut reported = analyse(workers, chosen, &plan)?;
    if declared.is_none() {
        reported = with_room_for_dynamics(workers, reported, (records, &plan))?;
    }
    Ok(reported.report(workers))
}

/// The analysis of one choice; of two, that one step ahead where it shows a cause with which no simulator is needed.
fn analyse(
    workers: &impl Workers,
    choice: Choice,
    plan: &impl Fn(Chosen) -> Result<Plan, DiagnoseError>,
) -> Result<Analysis, DiagnoseError> {
    let (mut steps, simulator) = match choice {
        Choice::One(chosen) => return Ok(Analysis::run(workers, plan(chosen)?)),
        Choice::Either(steps, simulator) => (plan(steps)?, simulator),
    };
    steps.pair_effort = PairEffort::WhileHopeful;
    let steps = Analysis::run(workers, steps);
    let verdict = &steps.conclusion.verdict;
    let reported = matches!(verdict.status, Status::Named | Status::Class);
    // No simulator sees noise that is asked for.
    let is_asked = verdict.effects.iter().any(|effect| steps.plan.settings.asked.contains(effect));
    let is_needless =
        reported && simulator.is_needless_beside(&steps.plan.dataset, &steps.conclusion.augmented.fit);
    if is_asked || is_needless && !refit::shows_dynamics(verdict) {
        return Ok(steps);
    }
    let chosen = simulator.chosen();
    // Dynamics that a simulator of another structure has without any effect are the machine's own.
    if is_needless && !steps.does_the_same(&chosen) {
        return Ok(steps);
    }
    let runs = Analysis::run(workers, plan(chosen)?);
    // A simulator may be blind to an effect that it leaves alone.
    Ok(match (verdict.status, runs.conclusion.verdict.status) {
        (Status::Unexplained, Status::None) => steps,
        _ => runs,
    })
}

/// The analysis on a nominal model with room for the machine's own dynamics, where one of those, or a delay, would be reported and a higher
/// order or another delay does the same on the held-out records. Its verdict counts, unless it is such an effect again, or
/// nothing of use: then the order is the answer.
fn with_room_for_dynamics(
    workers: &impl Workers,
    first: Analysis,
    (records, plan): (&Dataset, &impl Fn(Chosen) -> Result<Plan, DiagnoseError>),
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
    let again = Analysis::run(workers, plan(chosen)?);
    let verdict = &again.conclusion.verdict;
    if refit::shows_dynamics(verdict) || verdict.status == Status::Unexplained {
        let conclusion = first.plan.refitted(first.conclusion, &again.plan);
        return Ok(Analysis { conclusion, ..first });
    }
    Ok(again)
}
