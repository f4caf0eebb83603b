//! Measured and simulated outputs of every record as one CSV file.

use crate::diagnosis::Report;
use crate::identification::Identification;
use crate::output::csv_cell;
use std::fmt::Write;
use switchback_estimator::rig::{Rig, RigRecord};

/// `record,use,t,v,y,nominal,augmented`: every record of a diagnosis, fitted or held out; times start at zero in every record. Before the
/// first counted sample the simulations are the measured output. `nominal` is the model under diagnosis, empty where it has no prediction.
pub fn diagnosed_series(report: &Report) -> String {
    let models = report.diagnosis.models.as_ref();
    let runs = |number: usize, record: &RigRecord| {
        let (v, y) = (record.record.v(), record.record.y());
        let nominal = models.and_then(|m| m.nominal.as_ref()).map(|model| model.outputs(number, v, y));
        let nominal = nominal.or_else(|| record.predicted.clone());
        vec![nominal, models.map(|m| m.augmented.outputs(number, v, y))]
    };
    table(&report.rig, &["nominal", "augmented"], runs)
}

/// `record,use,t,v,y,simulated`: every record of an identification; empty where the model has no run.
pub fn identified_series(rig: &Rig, identification: &Identification) -> String {
    table(rig, &["simulated"], |number, _| {
        vec![identification.runs[number].as_ref().map(|run| run.simulated.clone())]
    })
}

fn table(rig: &Rig, names: &[&str], runs: impl Fn(usize, &RigRecord) -> Vec<Option<Vec<f64>>>) -> String {
    let mut text = format!("record,use,t,v,y,{}\n", names.join(","));
    for (number, record) in rig.records.iter().enumerate() {
        let runs = runs(number, record);
        let name = quoted(&csv_cell(&record.name));
        for (t, (v, y)) in record.record.v().iter().zip(record.record.y()).enumerate() {
            let _ = write!(text, "{name},{},{},{v},{y}", record.usage.name(), stamp(t, rig.sample_time));
            for run in &runs {
                let _ = match run {
                    Some(run) => write!(text, ",{}", run[t]),
                    None => write!(text, ","),
                };
            }
            text.push('\n');
        }
    }
    text
}

/// A time that carries no rounding errors of the product.
fn stamp(t: usize, sample_time: f64) -> f64 {
    let product = t as f64 * sample_time;
    format!("{product:.11e}").parse().unwrap_or(product)
}

/// A cell of a CSV file.
fn quoted(name: &str) -> String {
    if name.contains([',', '"', '\n']) {
        format!("\"{}\"", name.replace('"', "\"\""))
    } else {
        name.to_owned()
    }
}
