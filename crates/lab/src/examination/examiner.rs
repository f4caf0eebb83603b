//! Who diagnoses.

use switchback_diagnose::{DiagnoseError, Diagnosis, Model, Settings};
use switchback_model::rig::Rig;

/// Who diagnoses: a function of what a user's folder holds, of a model given or none, and of settings.
pub type Examiner = fn(&Rig, Model, &Settings) -> Result<Diagnosis, DiagnoseError>;
