//! A machine beside a model, a simulator or other records: the diagnosis of what differs between both.

use switchback_identify::free::FreeError;
use switchback_model::Record;
use switchback_model::linear::is_stable;
use switchback_model::reversal::ReversalRule;
use switchback_model::rig::{Rig, Usage};
use switchback_model::system::{Borders, LinearPart, Sensor, System};

use super::given_model::GivenModel;
use super::own::of_own_model;
use super::plan::{Plan, judged_scaled_records, lacks};
use super::report::{Conclusion, Other};
use crate::diagnosis::{Candidate, Diagnosis};
use crate::differences::{
    Basis, Differences, MachineRecord, Source, causes, compare_with, is_imitation, missing,
};
use crate::effect::Effect;
use crate::error::DiagnoseError;
use crate::evidence::Judged;
use crate::nominal::order::{Choice, declared, structure};
use crate::nominal_model::NominalModel;
use crate::phase::Phase;
use crate::posterior::Classification;
use crate::records::dataset::{Dataset, dimensionless};
use crate::settings::{Model, Settings};
use crate::verdict::answer::{Status, Verdict, naming_nothing};
use crate::verdict::odds::Odds;
use crate::workers::Workers;

/// Compares a rig with the model or the source, and reports the differences.
pub(super) fn compared(
    workers: &impl Workers,
    rig: &Rig,
    model: Model,
    settings: &Settings,
) -> Result<Diagnosis, DiagnoseError> {
    workers.begin(Phase::Nominal);
    let dataset = Dataset::new(rig)?;
    let declared = declared(rig, &model)?;
    let is_designed = dataset.is_designed();
    // What is wrong with the model or its predictions comes first.
    let judged = judged_scaled_records(&dataset, &mut Vec::new());
    GivenModel::of(&model, rig, &dataset, &judged)?;
    let differences = differences(workers, rig, &model)?;
    // Where only other records are known, the model under diagnosis is the system that stands for them.
    let (rig, model) = match (&model, &differences) {
        (Model::Against(_), Some(found)) => (with_runs(rig, found), Model::Predicted),
        _ => (rig.clone(), model),
    };
    let chosen = match structure(workers, (&rig, dataset), declared, settings)? {
        Choice::One(chosen) | Choice::Either(chosen, _) => chosen,
    };
    let plan = Plan::new(&rig, &model, &Settings { effects: Vec::new(), ..settings.clone() }, chosen)?;
    workers.begin(Phase::Report);
    let diagnosis = report(plan, &rig, differences);
    let Some(found) = diagnosis.differences.clone() else { return Ok(diagnosis) };
    match diagnosis.verdict.status {
        Status::Unexplained => unexplained(workers, (&rig, settings), diagnosis, found),
        Status::Named if !is_designed => named(&rig, settings, diagnosis, found),
        _ => Ok(diagnosis),
    }
}

/// What differs from a source explains the gap, and an effect is among it: as likely as the posterior holds it after the comparison. Of records that nobody
/// designed the likelihood of a comparison is none, for no model of theirs is right.
fn named(
    rig: &Rig,
    settings: &Settings,
    diagnosis: Diagnosis,
    found: Differences,
) -> Result<Diagnosis, DiagnoseError> {
    let Some(classification) = beside(rig, settings, &found)? else { return Ok(diagnosis) };
    let leading = classification.leading_difference(&missing(&found.rows));
    let by_differences = diagnosis.verdict.effects.clone();
    let joined = with(diagnosis, classification.joined_by(leading));
    let is_confirmed = joined.verdict.status == Status::Named && joined.verdict.effects == by_differences;
    let basis = if is_confirmed { found.basis } else { Basis::Errors };
    Ok(Diagnosis { differences: Some(Differences { basis, ..found }), ..joined })
}

/// No difference explains the gap: the machine's own model decides, or the source's errors.
fn unexplained(
    workers: &impl Workers,
    (rig, settings): (&Rig, &Settings),
    diagnosis: Diagnosis,
    found: Differences,
) -> Result<Diagnosis, DiagnoseError> {
    if let Some(own) = of_own_nominal(workers, (rig, settings), &found) {
        return Ok(Diagnosis { differences: Some(Differences { basis: Basis::Nominal, ..found }), ..own });
    }
    let Some(classification) = beside(rig, settings, &found)? else { return Ok(diagnosis) };
    let diagnosis =
        Diagnosis { differences: Some(Differences { basis: Basis::Errors, ..found }), ..diagnosis };
    Ok(with(diagnosis, classification))
}

/// What the source's errors say. They are freed of the directions of the source's values, but not of those of effects that stand for another.
fn beside(
    rig: &Rig,
    settings: &Settings,
    found: &Differences,
) -> Result<Option<Classification>, DiagnoseError> {
    let runs: Vec<Vec<f64>> = found.runs.iter().map(|[run, _]| run.clone()).collect();
    let Ok(Some(judged)) = Judged::beside(rig, &runs) else { return Ok(None) };
    Ok(Some(Classification::of(&judged, settings)?))
}

/// Share of the source's mean square error below which its distance from the machine's own nominal model leaves both with the same gap.
const NEAR: f64 = 0.1;

/// The diagnosis of the machine's own nominal model, where the source runs as this does on the held-out records: a source fitted to the machine without an effect
/// has all its values off, and lacks the same as any other that is fitted so. None where it runs otherwise, or the rig shows no model of its own.
fn of_own_nominal(
    workers: &impl Workers,
    (rig, settings): (&Rig, &Settings),
    found: &Differences,
) -> Option<Diagnosis> {
    let own = of_own_model(workers, rig, settings).ok()?;
    let (mut apart, mut missed) = (0.0, 0.0);
    for series in &own.series {
        let at = rig.records.iter().position(|r| r.name == series.record)?;
        let source = &found.runs[at][0];
        let square = |y: &[f64]| source.iter().zip(y).map(|(run, y)| (run - y).powi(2)).sum::<f64>();
        apart += square(&series.nominal);
        missed += square(&series.measured);
    }
    (apart < NEAR * missed).then_some(own)
}

/// The diagnosis with the verdict of the posterior.
fn with(diagnosis: Diagnosis, classification: Classification) -> Diagnosis {
    let mut limitations = diagnosis.limitations;
    limitations.extend(lacks(&classification));
    let verdict = classification.verdict();
    // Where the source misses more than the noise, something is missing.
    let verdict = match verdict.status {
        Status::None if diagnosis.gap.before.ci90[0] > 0.0 => {
            naming_nothing(Status::Unexplained, None, classification.unexplained())
        }
        _ => verdict,
    };
    let mut candidates = diagnosis.candidates;
    candidates.iter_mut().for_each(|c| c.probability = classification.probability(c.effect));
    candidates.sort_by(|x, y| y.probability.total_cmp(&x.probability));
    Diagnosis {
        verdict,
        limitations,
        candidates,
        probability_none: classification.none,
        probability_unexplained: classification.unexplained(),
        classification: Some(classification),
        ..diagnosis
    }
}

/// The comparison itself; none where the source has no gain at rest.
fn differences(
    workers: &impl Workers,
    rig: &Rig,
    model: &Model,
) -> Result<Option<Differences>, DiagnoseError> {
    let source = match model {
        Model::Identify => return Ok(None),
        Model::Predicted => Source::Predictions,
        Model::Given(model) => match system(model) {
            Some(system) => Source::Model(Box::new(system)),
            None => return Ok(None),
        },
        Model::Against(records) => {
            overlap(rig, records)?;
            Source::Records(records.clone())
        }
    };
    let whole = |predicted: &&Vec<f64>, record: &Record| {
        predicted.len() == record.len() && predicted.iter().all(|y| y.is_finite())
    };
    // Where only held-out records have predictions the comparison has no others.
    let is_known = |usage: Usage| {
        rig.records
            .iter()
            .any(|r| r.usage == usage && r.predicted.as_ref().is_some_and(|p| whole(&p, &r.record)))
    };
    let fitted = match source == Source::Predictions && !is_known(Usage::Fit) {
        true => Usage::Holdout,
        false => Usage::Fit,
    };
    let machine = rig.records.iter().map(|r| MachineRecord {
        record: &r.record,
        predicted: r.predicted.as_ref().filter(|p| whole(p, &r.record)).map(Vec::as_slice),
        is_fitted: r.usage == fitted,
    });
    compare_with(workers, &machine.collect::<Vec<_>>(), &source).map_err(|error| refused(&error))
}

fn refused(error: &FreeError) -> DiagnoseError {
    DiagnoseError::Comparison { reason: error.to_string() }
}

/// A given model as a system; none where its gain at rest is zero.
fn system(model: &NominalModel) -> Option<System> {
    if !is_stable(&model.a) {
        return None;
    }
    let (linear, gain) = LinearPart::new(&model.a, &model.b, 1)?;
    let scaled = |points: &[(f64, f64)]| points.iter().map(|(v, u)| (*v, gain * u)).collect::<Vec<_>>();
    let borders = Borders::new(&scaled(&model.descending), &scaled(&model.ascending))?;
    Some(System { borders, linear, sensor: Sensor::EXACT, terms: Vec::new(), rule: ReversalRule::EXACT })
}

/// Share of the smaller of two ranges that must lie in the other.
const OVERLAP: f64 = 0.5;

fn overlap(rig: &Rig, records: &[Record]) -> Result<(), DiagnoseError> {
    let range = |values: &mut dyn Iterator<Item = f64>| {
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
    };
    let (here_low, here_high) = range(&mut rig.records.iter().flat_map(|r| r.record.v().iter().copied()));
    let (there_low, there_high) = range(&mut records.iter().flat_map(|r| r.v().iter().copied()));
    let common = here_high.min(there_high) - here_low.max(there_low);
    if common < OVERLAP * (here_high - here_low).min(there_high - there_low) {
        return Err(DiagnoseError::Ranges { here_low, here_high, there_low, there_high });
    }
    Ok(())
}

fn with_runs(rig: &Rig, found: &Differences) -> Rig {
    let mut rig = rig.clone();
    for (record, [run, _]) in rig.records.iter_mut().zip(&found.runs) {
        record.predicted = Some(run.clone());
    }
    rig
}

fn report(mut plan: Plan, rig: &Rig, differences: Option<Differences>) -> Diagnosis {
    // Its own nominal model measures the machine's noise and is not what is asked about: nobody needs to know of its order.
    plan.limitations.retain(|limitation| !limitation.starts_with("the rig declares no order"));
    let Some(found) = differences else {
        plan.limitations.push(
            "what was compared has no gain at rest, so that its values cannot be set against those of the machine"
                .into(),
        );
        let verdict = naming_nothing(Status::Unexplained, None, 1.0);
        let conclusion = conclusion(&plan, verdict, None);
        return plan.report(conclusion, Vec::new(), None);
    };
    for shift in &found.shifts {
        plan.limitations.push(format!(
            "record `{}` lies {:+.3e} ± {:.1e} output units beside the aligned prediction: its zero is not that of the records that were \
             fitted",
            rig.records[shift.record].name, shift.offset, shift.se
        ));
    }
    let runs = plan
        .judged
        .iter()
        .map(|&k| dimensionless(&found.runs[k][1], plan.dataset.y_mean, plan.dataset.y_scale));
    let runs: Vec<Vec<f64>> = runs.collect();
    let floor = floor(&plan, &found);
    let verdict = verdict(&plan, &found, floor.0);
    let other = Other { structure: plan.structure, runs, floor };
    let candidates = candidates(&found);
    let conclusion = conclusion(&plan, verdict, Some(other));
    Diagnosis { differences: Some(found), ..plan.report(conclusion, candidates, None) }
}

/// Variance of the machine's noise and its relative standard error: that which its own model leaves, or the aligned source, whichever leaves less.
fn floor(plan: &Plan, found: &Differences) -> (f64, f64) {
    let own = plan.noise_floor(&plan.nominal.plain.fit);
    let records = &plan.dataset.scaled_records;
    let (aligned, count) = aligned_error(plan, found, (0..records.len()).filter(|k| records[*k].is_fit()));
    if count > 0.0 && aligned < own.0 { (aligned, 2.0 * (2.0 / count).sqrt()) } else { own }
}

fn conclusion(plan: &Plan, verdict: Verdict, other: Option<Other>) -> Conclusion {
    let probability = verdict.probability;
    let (none, unexplained) = match verdict.status {
        Status::None => (probability, 1.0 - probability),
        Status::Unexplained => (1.0 - probability, probability),
        _ => (0.0, 1.0 - probability),
    };
    Conclusion {
        fitted: Vec::new(),
        singles: Vec::new(),
        odds: Odds { effects: Vec::new(), none, unexplained },
        verdict: Verdict { calibrated: false, ..verdict },
        augmented: plan.nominal.plain.clone(),
        left: 0.0,
        together: None,
        other,
    }
}

fn verdict(plan: &Plan, found: &Differences, floor: f64) -> Verdict {
    let differs = found.rows.iter().any(|row| row.differs);
    if is_imitation(&found.rows) && !plan.dataset.is_designed() {
        return naming_nothing(Status::Unexplained, None, 1.0);
    }
    let probability =
        found.rows.iter().filter(|row| row.differs).map(|row| row.probability).fold(1.0, f64::min);
    let (left, _) = aligned_error(plan, found, plan.judged.iter().copied());
    let explains = left / floor.max(f64::MIN_POSITIVE) < EXPLAINED;
    let effects = causes(&missing(&found.rows), explains);
    match effects.first() {
        Some(first) => Verdict {
            stage: Some(first.stage()),
            effects,
            ..naming_nothing(Status::Named, None, probability)
        },
        None if !explains => naming_nothing(Status::Unexplained, None, 1.0),
        None if differs => naming_nothing(Status::Parameters, None, probability),
        None => naming_nothing(Status::None, None, 1.0 - most_probable_change(found)),
    }
}

/// Mean square error of the aligned source on some records, dimensionless, and the samples that it is of.
fn aligned_error(plan: &Plan, found: &Differences, records: impl Iterator<Item = usize>) -> (f64, f64) {
    let (mut square, mut count) = (0.0, 0.0);
    for k in records {
        let run = dimensionless(&found.runs[k][1], plan.dataset.y_mean, plan.dataset.y_scale);
        let record = &plan.dataset.scaled_records[k];
        for t in record.from..record.y.len() {
            square += (record.y[t] - run[t]).powi(2);
            count += 1.0;
        }
    }
    (square / f64::max(count, 1.0), count)
}

/// Mean square error over the noise up to which the aligned source explains the records: the noise itself has one, and the same again is a misfit as large as the noise.
const EXPLAINED: f64 = 2.0;

/// The largest probability of a difference that was not taken.
fn most_probable_change(found: &Differences) -> f64 {
    found.rows.iter().filter(|row| !row.differs).map(|row| row.probability).fold(0.0, f64::max)
}

fn candidates(found: &Differences) -> Vec<Candidate> {
    let one = |(effect, row): (Effect, &crate::differences::Row)| Candidate {
        effect,
        stage: effect.stage(),
        probability: row.probability,
        parameters: Vec::new(),
        bic: -row.gain,
        delta_bic: row.gain,
        heldout_log_score: 0.0,
        gains: Vec::new(),
        // Differences beside one that is left out can take the source farther away than it was.
        closure: Some(row.closure.min(1.0)),
        unstable: false,
    };
    missing(&found.rows).into_iter().map(one).collect()
}
