//! The identification as one JSON object.

use super::Identification;
use crate::output::stamped;
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use switchback_estimator::estimators::BorderPoint;
use switchback_estimator::rig::{Rig, Usage};

/// Name and version of the layout.
const SCHEMA: &str = "switchback/identify/1";

/// The object that `identify --json` prints; figures that do not exist are null.
#[derive(Serialize)]
struct Page<'a> {
    rig: &'a str,
    method: &'static str,
    order: usize,
    delay: isize,
    a: &'a [f64],
    a_se: &'a [f64],
    b: &'a [f64],
    b_se: &'a [f64],
    noise_sd: f64,
    gain: f64,
    y_high: f64,
    y_low: f64,
    descendant: Vec<Point>,
    ascendant: Vec<Point>,
    fit_percent: FitByRecord<'a>,
    excitation: f64,
    samples: usize,
    records: Vec<RecordFit<'a>>,
    warnings: &'a [String],
    version: &'static str,
}

#[derive(Serialize)]
struct Point {
    v: f64,
    f: f64,
    se: f64,
}

#[derive(Serialize)]
struct RecordFit<'a> {
    name: &'a str,
    r#use: &'static str,
    samples: usize,
    fit_percent: Option<f64>,
}

/// `{record: fit %}` in the order of the rig.
struct FitByRecord<'a>(&'a [RecordFit<'a>]);

impl Serialize for FitByRecord<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for record in self.0 {
            map.serialize_entry(record.name, &record.fit_percent)?;
        }
        map.end()
    }
}

/// One JSON object, indented, with a newline at its end.
pub fn json(rig: &Rig, identification: &Identification) -> String {
    let estimate = &identification.estimate;
    let records = || -> Vec<RecordFit<'_>> {
        rig.records
            .iter()
            .zip(&identification.runs)
            .map(|(record, run)| RecordFit {
                name: &record.name,
                r#use: match record.usage {
                    Usage::Fit => "fit",
                    Usage::Holdout => "holdout",
                },
                samples: record.record.len(),
                fit_percent: run.as_ref().map(|run| run.fit_percent),
            })
            .collect()
    };
    let by_record = records();
    let page = Page {
        rig: &rig.name,
        method: identification.method.name(),
        order: estimate.a.len(),
        delay: estimate.delay,
        a: &estimate.a,
        a_se: &estimate.a_se,
        b: &estimate.b,
        b_se: &estimate.b_se,
        noise_sd: estimate.noise_sd,
        gain: estimate.gain,
        y_high: estimate.y_high,
        y_low: estimate.y_low,
        descendant: points(&estimate.descending),
        ascendant: points(&estimate.ascending),
        fit_percent: FitByRecord(&by_record),
        excitation: estimate.excitation,
        samples: estimate.samples,
        records: records(),
        warnings: &identification.warnings,
        version: env!("CARGO_PKG_VERSION"),
    };
    stamped(SCHEMA, &page)
}

fn points(border: &[BorderPoint]) -> Vec<Point> {
    border.iter().map(|point| Point { v: point.v, f: point.f, se: point.se }).collect()
}
