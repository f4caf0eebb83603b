//! Methods for any record of a rig, and the baselines.

use super::{Examination, Flag, Found, FreeRun, Identification, IdentificationError, Request, causal, unit};
use crate::model::Curves;
use switchback_identify::free::{
    FreeError, InputMap, Model, Progress, Settings, identify_watched as estimate,
};
use switchback_model::Record;
use switchback_model::rig::Rig;

/// Identifies from all fit records, whatever drove them.
pub(super) fn identify(
    rig: &Rig,
    Request { method, causal }: Request,
    input_map: InputMap,
    progress: &dyn Progress,
) -> Result<Identification, IdentificationError> {
    let records: Vec<&Record> = rig.fit_records().map(|record| &record.record).collect();
    let settings = Settings { order: rig.order, interval: rig.interval, causal, ..Settings::new(input_map) };
    let identified =
        estimate(&records, &settings, progress).map_err(|error| IdentificationError::Refused {
            rig: rig.name.clone(),
            method,
            remedy: remedy(&error, rig),
            // What follows is reported in the terms of the files.
            reason: error.to_string().split("; ").next().unwrap_or_default().to_owned(),
        })?;
    let model = Found::Curves(Curves::of(&identified));
    Ok(Identification {
        method,
        model: Some(model),
        estimate: identified.estimate,
        runs: rig.records.iter().map(|record| run(&identified.model, &record.record)).collect(),
        level_errors: identified.level_errors,
        distance: identified.distance,
        input_noise: identified.input_noise,
        obstacles: causal::obstacles(&identified.model, unit(&rig.input_label)),
        flags: identified.warnings.iter().map(Flag::from).collect(),
        examination: Examination::default(),
    })
}

/// None where the input never moves beyond the reversal threshold, so that the branch is unknown all along.
fn run(model: &Model, record: &Record) -> Option<FreeRun> {
    let run = model.free_run(record);
    (run.start < record.len()).then(|| FreeRun::new(record.y(), run.y, run.start))
}

/// What to change in the files; the error itself says what is wrong with them.
fn remedy(error: &FreeError, rig: &Rig) -> String {
    let (input, output) = (&rig.input_label, &rig.output_label);
    match error {
        FreeError::TooShort { .. } => {
            "give longer fit records, or a lower `order` in a rig file, as `switchback init` writes one".to_owned()
        }
        FreeError::NoMotion { .. } => {
            format!("check that `{input}` is the column of the input, and drive it through its interval")
        }
        FreeError::ConstantOutput => format!("check that `{output}` is the column of the output"),
        FreeError::UnvisitedKnot { .. } => {
            "narrow `interval` in a rig file, as `switchback init` writes one, to where the records go".to_owned()
        }
        _ => "check the fit records for drift and faults, or set another `order` in a rig file, as `switchback init` writes one".to_owned(),
    }
}
