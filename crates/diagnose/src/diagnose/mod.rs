//! The diagnosis itself: the nominal model, attribution, verdict, report.

mod attribute;
mod changed;
mod compared;
mod evidence;
mod exact;
mod given_model;
mod harm;
mod held_out;
mod judged;
mod nominal;
mod other_conditions;
mod parameters;
mod plan;
mod refit;
mod report;
mod ways;

use switchback_model::rig::Rig;

use self::plan::Plan;
use self::ways::{Way, Ways};
use crate::attribution::PairEffort;
use crate::diagnosis::Diagnosis;
use crate::error::DiagnoseError;
use crate::nominal::order::{Choice, Chosen, declared, of_structure, structure};
use crate::phase::Phase;
use crate::records::campaign::Campaign;
use crate::settings::{Model, Settings};
use crate::verdict::answer::Status;
use crate::workers::{Serial, Workers};

/// Diagnoses the gap between a model and a rig.
///
/// Identifies (or takes) the nominal model, fits every effect of the library together with it, ranks them by penalised
/// likelihood, tests what the best leaves, and measures how far it closes the gap on the held-out records.
///
/// # Errors
/// [`DiagnoseError`] where nothing can be judged; what can be judged only in part becomes a
/// [limitation](Diagnosis::limitations).
pub fn diagnose(rig: &Rig, model: Model, settings: &Settings) -> Result<Diagnosis, DiagnoseError> {
    diagnose_with(&Serial, rig, model, settings)
}

/// [`diagnose`], its independent pieces of work given to `workers`; the answer does not depend on them.
///
/// # Errors
/// As [`diagnose`].
pub fn diagnose_with(
    workers: &impl Workers,
    rig: &Rig,
    model: Model,
    settings: &Settings,
) -> Result<Diagnosis, DiagnoseError> {
    workers.begin(Phase::Nominal);
    let records = Campaign::new(rig)?;
    let declared = declared(rig, &model)?;
    let plan = |chosen: Chosen| Plan::new(rig, &model, settings, chosen);
    let chosen = structure(workers, records.clone(), declared, settings)?;
    let held =
        changed::plan(workers, (rig, &model), &records, settings)?.map(|plan| Way::gone(workers, plan));
    // Where parameters are all that has changed nothing is missing.
    let counts = held.as_ref().is_some_and(|way| way.tells_a_cause() && !way.does_the_same(chosen.first()));
    let (mut told, mut others) = gone(workers, chosen, &plan)?;
    if declared.is_none() {
        told = with_room_for_dynamics(workers, told, (&records, &plan))?;
    }
    match held {
        Some(held) if counts && (told.leaves_open(&held) || !held.is_outdone_by(&told)) => {
            others.push(std::mem::replace(&mut told, held))
        }
        held => others.extend(held),
    }
    Ok(Ways::new(workers, told, others).report(workers))
}

/// The way of one choice; of two, that one step ahead where it tells a cause with which no simulator is needed. Behind it the other way,
/// where that was gone, too.
fn gone(
    workers: &impl Workers,
    choice: Choice,
    plan: &impl Fn(Chosen) -> Result<Plan, DiagnoseError>,
) -> Result<(Way, Vec<Way>), DiagnoseError> {
    let (mut steps, simulator) = match choice {
        Choice::One(chosen) => return Ok((Way::gone(workers, plan(chosen)?), Vec::new())),
        Choice::Either(steps, simulator) => (plan(steps)?, simulator),
    };
    steps.pair_effort = PairEffort::WhileHopeful;
    let steps = Way::gone(workers, steps);
    let verdict = &steps.conclusion.verdict;
    let told = matches!(verdict.status, Status::Named | Status::Class);
    // No simulator sees noise that is asked for.
    let is_asked = verdict.effects.iter().any(|effect| steps.plan.settings.asked.contains(effect));
    if is_asked || told && simulator.is_needless_beside(&steps.plan.campaign, &steps.conclusion.augmented.fit)
    {
        return Ok((steps, Vec::new()));
    }
    let runs = Way::gone(workers, plan(simulator.chosen())?);
    // What a simulator leaves alone may be what it cannot see.
    Ok(match (verdict.status, runs.conclusion.verdict.status) {
        (Status::Unexplained, Status::None) => (steps, vec![runs]),
        _ => (runs, vec![steps]),
    })
}

/// The way on a nominal model with room for the machine's own dynamics, where one of those, or a delay, would be told and a higher
/// order or another delay does the same on the held-out records. What that one tells counts, unless it is such an effect again, or
/// nothing of use: then the order is the answer.
fn with_room_for_dynamics(
    workers: &impl Workers,
    first: Way,
    (records, plan): (&Campaign, &impl Fn(Chosen) -> Result<Plan, DiagnoseError>),
) -> Result<Way, DiagnoseError> {
    if !refit::tells_dynamics(&first.conclusion.verdict) {
        return Ok(first);
    }
    let simulates = first.plan.campaign.criterion.simulates();
    let wider = first.plan.structure.wider(refit::tells_a_delay(&first.conclusion.verdict));
    let fitted = workers.map(&wider, |structure| of_structure(records, *structure, simulates).ok());
    let Some(chosen) = fitted.into_iter().flatten().find(|chosen| first.does_the_same(chosen)) else {
        return Ok(first);
    };
    let again = Way::gone(workers, plan(chosen)?);
    let verdict = &again.conclusion.verdict;
    if refit::tells_dynamics(verdict) || verdict.status == Status::Unexplained {
        let conclusion = first.plan.refitted(first.conclusion, &again.plan);
        return Ok(Way { conclusion, ..first });
    }
    Ok(again)
}
