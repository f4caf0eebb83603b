//! A single file of measurements, read as `switchback gap FILE` reads it.

use super::{Scratch, reported};
use switchback_io::rig::{self, ColumnNames, HELD_OUT, InputForm, Plan, PlannedRecord, Sampling};
use switchback_model::rig::{Role, Usage};

/// Reads bytes as a file of that name: a rig whose numbers are finite, or a refusal in words.
pub fn one_file(folder: &Scratch, name: &str, bytes: &[u8]) {
    let path = folder.write(name, bytes);
    let record = PlannedRecord {
        named: name.to_owned(),
        path,
        columns: ColumnNames::default(),
        role: Role::Free,
        usage: Usage::Fit,
        held_out: Some(HELD_OUT),
    };
    let plan = Plan {
        name: "fuzz".to_owned(),
        columns: ColumnNames::default(),
        sampling: Sampling::default(),
        order: None,
        interval: None,
        input_label: None,
        output_label: None,
        records: vec![record],
        input_form: InputForm::CommandLine("switchback gap".to_owned()),
    };
    match rig::load_plan(&plan) {
        Ok(loaded) => {
            assert!(loaded.rig.sample_time > 0.0 && loaded.rig.sample_time.is_finite());
            for record in &loaded.rig.records {
                let numbers = record.record.v().iter().chain(record.record.y());
                assert!(numbers.copied().all(f64::is_finite));
            }
        }
        Err(refusal) => reported(&refusal),
    }
}
