//! The diagnosis itself: the nominal model, attribution, verdict, report.

mod analyses;
mod attribute;
mod compared;
mod degradation;
mod evidence;
mod exact;
mod given_model;
mod held_out;
mod judged;
mod nominal;
mod other_conditions;
mod own;
mod parameters;
mod plan;
mod refit;
mod report;
mod rig_evidence;
mod sources;

use switchback_model::rig::Rig;

use crate::diagnosis::Diagnosis;
use crate::error::DiagnoseError;
use crate::settings::{Model, Settings};
use crate::workers::{Serial, Workers};

/// Diagnoses the gap between a model and a rig.
///
/// Identifies the nominal model and asks a trained [posterior](crate::posterior) for the likeliest effects; fits these together with the model, joins their
/// probabilities by the fits, and measures how far the likeliest closes the gap on the held-out records. A model that is given, a simulator or other
/// records are compared value by value; of records that nobody designed the posterior decides about what is missing.
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
    match model {
        Model::Identify => own::of_own_model(workers, rig, settings),
        model => sources::compared(workers, rig, model, settings),
    }
}
