//! Diagnosing a sealed rig, and opening its key afterwards.

use super::case::Case;
use super::seal::Sealed;
use crate::generate::MakeError;
use switchback_diagnose::{DiagnoseError, Diagnosis, Effect, Settings};
use switchback_model::rig::Rig;

/// Who diagnoses: a function of what a user's folder holds and of the effects to consider.
pub type Examiner<'a> = &'a (dyn Fn(&Rig, &Settings) -> Result<Diagnosis, DiagnoseError> + Sync);

/// Diagnoses a rig, and opens its key afterwards.
///
/// # Errors
/// [`MakeError`] never in practice: every recipe was made before.
pub fn examine(sealed: &Sealed, examiner: Examiner<'_>) -> Result<Case, MakeError> {
    let diagnosis = examiner(&sealed.rig()?, &settings(sealed)).ok();
    Ok(Case::judge(sealed.ticket(), diagnosis.as_ref(), &sealed.open()?))
}

/// The defaults, less the effect that is taken out of the library for this rig.
fn settings(sealed: &Sealed) -> Settings {
    let withheld = sealed.ticket().withheld.and_then(Effect::from_name);
    Settings::default().without(withheld.as_slice())
}
