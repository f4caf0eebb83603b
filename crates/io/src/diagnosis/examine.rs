//! The diagnosis, its independent pieces on all cores.

use super::shift::{Shift, restored, shifts, without};
use super::stability::Stability;
use super::{DiagnosisError, Source, Subject};
use crate::progress::Stages;
use rayon::prelude::*;
use switchback_diagnose::{Diagnosis, Effect, Model, Phase, Settings, Workers, diagnose_with};
use switchback_model::rig::Rig;

/// A diagnosis with the rig it is about.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// The rig.
    pub rig: Rig,
    /// Whose model met the records.
    pub source: Source,
    /// What was found.
    pub diagnosis: Diagnosis,
    /// Held-out recordings with another zero or gain than the fit records, which the diagnosis is without.
    pub shifts: Vec<Shift>,
    /// The verdicts of parts of the records, where these were asked for.
    pub stability: Option<Stability>,
}

/// Pieces of a diagnosis as tasks of the thread pool, counted as they are done.
struct Pool<'a>(&'a dyn Stages);

impl Workers for Pool<'_> {
    fn map<T: Sync, R: Send>(&self, items: &[T], work: impl Fn(&T) -> R + Sync + Send) -> Vec<R> {
        self.0.found(items.len());
        let counted = |item: &T| {
            let result = work(item);
            self.0.did_one();
            result
        };
        // Pieces differ much in size: each is a task of its own.
        items.par_iter().with_max_len(1).map(counted).collect()
    }

    fn begin(&self, phase: Phase) {
        self.0.begin(phase.name());
    }
}

/// Diagnoses on all cores; the result does not depend on how many there are.
///
/// # Errors
/// [`DiagnosisError`] where nothing can be judged; what can be judged only in part becomes a limitation of the report.
pub fn examine(subject: Subject, settings: &Settings) -> Result<Report, DiagnosisError> {
    examine_watched(subject, settings, &())
}

/// [`examine`], which shows how far it has come.
///
/// # Errors
/// As [`examine`].
pub fn examine_watched(
    subject: Subject,
    settings: &Settings,
    progress: &dyn Stages,
) -> Result<Report, DiagnosisError> {
    let Subject { rig, model, source, notes } = subject;
    let is_identified = model == Model::Identify;
    let diagnosed = |rig: &Rig, model: Model| {
        diagnose_with(&Pool(progress), rig, model, settings)
            .map_err(|error| DiagnosisError::new(&rig.name, &error))
    };
    let mut diagnosis = diagnosed(&rig, model)?;
    // A source beside the machine is aligned with it by its differences.
    let mut shifts = if is_identified { shifts(&rig, &diagnosis) } else { Vec::new() };
    if !shifts.is_empty() {
        diagnosis = diagnosed(&without(&rig, &shifts), Model::Identify)?;
        shifts = restored(&mut diagnosis, &shifts);
    }
    diagnosis.limitations.extend(notes);
    diagnosis.limitations.extend(left_out(settings));
    Ok(Report { rig, source, diagnosis, shifts, stability: None })
}

/// What a reader must know where candidates were left out.
fn left_out(settings: &Settings) -> Option<String> {
    let names: Vec<&str> =
        Effect::ALL.into_iter().filter(|e| !settings.effects.contains(e)).map(Effect::name).collect();
    (!names.is_empty()).then(|| format!("left out of the candidates, as asked: {}", names.join(", ")))
}
