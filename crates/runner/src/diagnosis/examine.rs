//! The diagnosis, one candidate a task.

use super::{DiagnosisError, Source, Subject};
use rayon::prelude::*;
use switchback_estimator::rig::Rig;
use switchback_gap::{Diagnosis, Plan, Settings};

/// A diagnosis with the rig it is about.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// The rig.
    pub rig: Rig,
    /// Whose model met the records.
    pub source: Source,
    /// What was found.
    pub diagnosis: Diagnosis,
}

/// Diagnoses with the default settings; the candidates are fitted in parallel, and the result does not depend on it.
///
/// # Errors
/// [`DiagnosisError`] where nothing can be judged; what can be judged only in part becomes a limitation of the report.
pub fn examine(subject: Subject) -> Result<Report, DiagnosisError> {
    let Subject { rig, model, source, notes } = subject;
    let refused = |error| DiagnosisError::new(&rig.name, &error);
    let plan = Plan::new(&rig, model, &Settings::default()).map_err(refused)?;
    let fits = plan.effects().par_iter().map(|&effect| plan.fit_candidate(effect)).collect();
    let mut diagnosis = plan.conclude(fits);
    diagnosis.limitations.extend(notes);
    Ok(Report { rig, source, diagnosis })
}
