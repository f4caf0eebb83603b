//! The identification as one JSON object.

use super::{CausalAlternative, Flag, Identification, Yardstick};
use crate::output::stamped;
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use switchback_estimator::estimators::{BorderDistance, BorderPoint};
use switchback_estimator::rig::Rig;

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
    gain_se: Option<f64>,
    y_high: f64,
    y_high_se: Option<f64>,
    y_low: f64,
    y_low_se: Option<f64>,
    descendant: Vec<Point>,
    ascendant: Vec<Point>,
    fit_percent: FitByRecord<'a>,
    excitation: f64,
    samples: usize,
    records: Vec<RecordFit<'a>>,
    /// Whether the model could run in real time.
    causal: bool,
    /// The best model that could, where this one could not.
    causal_alternative: Option<Causal<'a>>,
    yardsticks: Vec<Beside>,
    /// How far the borders lie apart.
    r#loop: Option<Loop>,
    innovations: Option<Innovations>,
    /// The sentences of `flags`.
    warnings: Vec<&'a str>,
    flags: Vec<Reservation<'a>>,
    version: &'static str,
}

#[derive(Serialize)]
struct Reservation<'a> {
    kind: &'static str,
    figure: Option<f64>,
    text: &'a str,
}

/// Another model on the held-out records.
#[derive(Serialize)]
struct Beside {
    method: &'static str,
    fit_percent: f64,
    own_fit_percent: f64,
    /// Mean excess of the own squared error, as a share of the output's variance, and its 95 % interval.
    excess: Option<[f64; 3]>,
}

#[derive(Serialize)]
struct Causal<'a> {
    order: usize,
    delay: isize,
    a: &'a [f64],
    b: &'a [f64],
    held_out: Option<Beside>,
}

#[derive(Serialize)]
struct Loop {
    told_apart: f64,
    clearest_v: f64,
    difference: f64,
    se: f64,
    z: f64,
    limit: f64,
}

#[derive(Serialize)]
struct Innovations {
    foretold: f64,
    ljung_box: f64,
    p_value: f64,
    lags: usize,
}

impl From<&Yardstick> for Beside {
    fn from(yardstick: &Yardstick) -> Self {
        Self {
            method: yardstick.method.name(),
            fit_percent: yardstick.fit_percent,
            own_fit_percent: yardstick.own_fit_percent,
            excess: yardstick.excess.map(|e| [e.mean, e.low, e.high]),
        }
    }
}

impl From<BorderDistance> for Loop {
    fn from(distance: BorderDistance) -> Self {
        let BorderDistance { clearest, z, limit, told_apart, .. } = distance;
        Self {
            told_apart,
            clearest_v: clearest.v,
            difference: clearest.difference,
            se: clearest.se,
            z,
            limit,
        }
    }
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
    let Identification { estimate, level_errors, examination, .. } = identification;
    let records = || -> Vec<RecordFit<'_>> {
        rig.records
            .iter()
            .zip(&identification.runs)
            .map(|(record, run)| RecordFit {
                name: &record.name,
                r#use: record.usage.name(),
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
        gain_se: level_errors.map(|e| e.gain),
        y_high: estimate.y_high,
        y_high_se: level_errors.map(|e| e.y_high),
        y_low: estimate.y_low,
        y_low_se: level_errors.map(|e| e.y_low),
        descendant: points(&estimate.descending),
        ascendant: points(&estimate.ascending),
        fit_percent: FitByRecord(&by_record),
        excitation: estimate.excitation,
        samples: estimate.samples,
        records: records(),
        causal: identification.obstacles.is_empty(),
        causal_alternative: examination.causal.as_ref().map(causal),
        yardsticks: examination.yardsticks.iter().map(Beside::from).collect(),
        r#loop: identification.distance.map(Loop::from),
        innovations: examination.innovations.map(|w| Innovations {
            foretold: w.foretold,
            ljung_box: w.ljung_box,
            p_value: w.p_value,
            lags: w.lags,
        }),
        warnings: identification.flags.iter().map(|flag| &*flag.text).collect(),
        flags: identification.flags.iter().map(reservation).collect(),
        version: env!("CARGO_PKG_VERSION"),
    };
    stamped(SCHEMA, &page)
}

fn reservation(flag: &Flag) -> Reservation<'_> {
    Reservation { kind: flag.kind, figure: flag.figure, text: &flag.text }
}

fn causal(alternative: &CausalAlternative) -> Causal<'_> {
    let estimate = &alternative.identification.estimate;
    Causal {
        order: estimate.a.len(),
        delay: estimate.delay,
        a: &estimate.a,
        b: &estimate.b,
        held_out: alternative.held_out.as_ref().map(Beside::from),
    }
}

fn points(border: &[BorderPoint]) -> Vec<Point> {
    border.iter().map(|point| Point { v: point.v, f: point.f, se: point.se }).collect()
}
