//! Diagnosing sealed rigs, and opening their keys afterwards.

use super::case::Case;
use super::seal::Sealed;
use rayon::prelude::*;
use switchback_estimator::rig::Rig;
use switchback_gap::{DiagnoseError, Diagnosis, Effect, Settings};
use switchback_maker::MakeError;

/// Who diagnoses: a function of what a user's folder holds and of the effects to consider.
pub type Examiner<'a> = &'a (dyn Fn(&Rig, &Settings) -> Result<Diagnosis, DiagnoseError> + Sync);

/// Diagnoses rigs in parallel, and opens the keys when all of them are diagnosed.
///
/// Results come in the order of `batch`, whatever the threads do. `done` hears of each rig.
///
/// # Errors
/// [`MakeError`] never in practice: every recipe was made before.
pub fn examine(
    batch: &[Sealed],
    examiner: Examiner<'_>,
    done: &(dyn Fn() + Sync),
) -> Result<Vec<Case>, MakeError> {
    let diagnosed: Vec<Option<Diagnosis>> = batch
        .par_iter()
        // One rig may take as long as twenty others: each is a task of its own.
        .with_max_len(1)
        .map(|one| {
            let diagnosis = examiner(&one.rig()?, &settings(one)).ok();
            done();
            Ok(diagnosis)
        })
        .collect::<Result<_, MakeError>>()?;
    batch
        .par_iter()
        .zip(diagnosed)
        .map(|(one, diagnosis)| Ok(Case::judge(one.ticket(), diagnosis.as_ref(), &one.open()?)))
        .collect()
}

/// The defaults, less the effect that is taken out of the library for this rig.
fn settings(sealed: &Sealed) -> Settings {
    let withheld = sealed.ticket().withheld.and_then(Effect::from_name);
    Settings::default().without(withheld.as_slice())
}
