//! From a [`Rig`] to its files.

use super::wire::{WrittenRecord, WrittenRig};
use crate::output::Artefacts;
use std::fmt::Write;
use switchback_model::rig::{Rig, RigRecord};

/// Name of the file that describes a rig.
pub const RIG_FILE: &str = "rig.toml";

/// The files of a rig: `rig.toml` and one CSV a record. [`read`](super::read) gives the same rig back, to the last bit.
///
/// Each record's time stamps start at zero. Its file is called as the record, with the ending `.csv`.
///
/// # Panics
/// If two records share a name, or one holds a path separator.
pub fn artefacts(rig: &Rig) -> Artefacts {
    let mut artefacts = Artefacts::default();
    artefacts.add(RIG_FILE, description(rig));
    for record in &rig.records {
        artefacts.add(file_name(record), rows(record, rig.sample_time));
    }
    artefacts
}

fn description(rig: &Rig) -> String {
    let page = WrittenRig {
        name: &rig.name,
        sample_time: rig.sample_time,
        order: rig.order,
        interval: rig.interval.map(|interval| [interval.low(), interval.high()]),
        input: &rig.input_label,
        output: &rig.output_label,
        record: rig
            .records
            .iter()
            .map(|record| WrittenRecord {
                file: file_name(record),
                role: record.role.name(),
                usage: record.usage.name(),
            })
            .collect(),
    };
    toml::to_string(&page).expect("strings, numbers and tables of them are TOML")
}

fn file_name(record: &RigRecord) -> String {
    format!("{}.csv", record.name)
}

/// Shortest decimals that read back as the same number.
fn rows(record: &RigRecord, sample_time: f64) -> String {
    let mut text = String::from(if record.predicted.is_some() { "t,v,y,y_sim\n" } else { "t,v,y\n" });
    let decimals = stamp_decimals(sample_time);
    for (k, (v, y)) in record.record.v().iter().zip(record.record.y()).enumerate() {
        let stamp = format!("{:.decimals$}", k as f64 * sample_time);
        let stamp = if decimals > 0 { stamp.trim_end_matches('0').trim_end_matches('.') } else { &stamp };
        let _ = write!(text, "{stamp},{v},{y}");
        if let Some(predicted) = &record.predicted {
            let _ = write!(text, ",{}", predicted[k]);
        }
        text.push('\n');
    }
    text
}

/// Decimals that resolve a thousandth of the sample time, or the sample time exactly where that takes up to six more.
fn stamp_decimals(sample_time: f64) -> usize {
    let resolving = (3.0 - sample_time.log10().floor()).max(0.0) as usize;
    (resolving..resolving + 6)
        .find(|decimals| format!("{sample_time:.decimals$}").parse() == Ok(sample_time))
        .unwrap_or(resolving)
}
