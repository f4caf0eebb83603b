//! The identification as one JSON object.

use super::{Baseline, CausalAlternative, Flag, Identification};
use crate::output::{stamped, stamped_schema};
use schemars::{JsonSchema, Schema};
use serde::de::{MapAccess, Visitor};
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::BTreeMap;
use std::fmt;
use switchback_identify::free::InputNoise;
use switchback_identify::{BorderDistance, BorderPoint, Method};
use switchback_model::rig::Rig;

/// Name and version of the layout.
pub const SCHEMA: &str = "switchback/identify/1";

/// An identification: `identify --json`, `estimate.json`. Figures that do not exist are null.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EstimateFile {
    /// The rig's name.
    pub rig: String,
    /// Label and unit of the input.
    pub input: String,
    /// Label and unit of the output.
    pub output: String,
    /// Seconds between samples.
    #[serde(deserialize_with = "crate::input::nullable::number")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub sample_time: f64,
    /// The method.
    #[schemars(with = "Method")]
    pub method: String,
    /// Order of the linear part.
    pub order: usize,
    /// Delay in samples; negative where the model looks ahead.
    pub delay: isize,
    /// `a₁…aₙ`.
    #[serde(deserialize_with = "crate::input::nullable::numbers")]
    pub a: Vec<f64>,
    /// Their standard errors.
    #[serde(deserialize_with = "crate::input::nullable::numbers")]
    #[schemars(with = "Vec<Option<f64>>")]
    pub a_se: Vec<f64>,
    /// `b₁…bₙ`, in output units where u_M − u_m = 1.
    #[serde(deserialize_with = "crate::input::nullable::numbers")]
    pub b: Vec<f64>,
    /// Their standard errors.
    #[serde(deserialize_with = "crate::input::nullable::numbers")]
    #[schemars(with = "Vec<Option<f64>>")]
    pub b_se: Vec<f64>,
    /// Standard deviation of the equation error, or of the free run's error.
    #[serde(deserialize_with = "crate::input::nullable::number")]
    #[schemars(range(min = 0))]
    pub noise_sd: f64,
    /// `B(1)/A(1)`, output units.
    #[serde(deserialize_with = "crate::input::nullable::number")]
    #[schemars(with = "Option<f64>")]
    pub gain: f64,
    /// Its standard error.
    pub gain_se: Option<f64>,
    /// Stationary output at the upper end.
    #[serde(deserialize_with = "crate::input::nullable::number")]
    #[schemars(with = "Option<f64>")]
    pub y_high: f64,
    /// Its standard error.
    pub y_high_se: Option<f64>,
    /// Stationary output at the lower end.
    #[serde(deserialize_with = "crate::input::nullable::number")]
    #[schemars(with = "Option<f64>")]
    pub y_low: f64,
    /// Its standard error.
    pub y_low_se: Option<f64>,
    /// Points of the falling border.
    pub descendant: Vec<Point>,
    /// Points of the rising border.
    pub ascendant: Vec<Point>,
    /// Fit in free run by record.
    #[schemars(with = "BTreeMap<String, Option<f64>>")]
    pub fit_percent: FitByRecord,
    /// Least eigenvalue of the information matrix over one period.
    #[serde(deserialize_with = "crate::input::nullable::number")]
    #[schemars(with = "Option<f64>")]
    pub excitation: f64,
    /// Samples fitted.
    pub samples: usize,
    /// The records.
    pub records: Vec<RecordFit>,
    /// Whether the model could run in real time.
    pub causal: bool,
    /// The best model that could, where this one could not.
    pub causal_alternative: Option<Causal>,
    /// Simpler models on the held-out records.
    #[serde(rename = "yardsticks")]
    pub baselines: Vec<Beside>,
    /// How far the borders lie apart.
    pub r#loop: Option<Loop>,
    /// What noise on the input does to the estimate; null where none was found.
    pub input_noise: Option<Moved>,
    /// Whether the one-step errors are white.
    pub innovations: Option<Innovations>,
    /// The sentences of `flags`.
    pub warnings: Vec<String>,
    /// What to know before trusting a figure.
    pub flags: Vec<Reservation>,
    /// Version of Switchback that wrote it.
    pub version: String,
}

/// A reason to doubt a figure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Reservation {
    /// One word for programs.
    pub kind: String,
    /// The figure that decided.
    pub figure: Option<f64>,
    /// One sentence.
    pub text: String,
}

/// By how much noise on the input moves the estimate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Moved {
    /// Standard deviation of the noise, input units.
    #[schemars(range(min = 0))]
    pub sd: f64,
    /// `sd` over the width of the working interval.
    #[schemars(range(min = 0))]
    pub share: f64,
    /// By how much the noise moves the coefficient or point that it moves most, in standard errors of that, by simulation.
    #[schemars(range(min = 0))]
    pub largest_shift: f64,
    /// Standard error of that by the number of simulated records, in the same unit.
    #[schemars(range(min = 0))]
    pub largest_shift_se: f64,
}

impl From<InputNoise> for Moved {
    fn from(InputNoise { sd, share, largest_shift, largest_shift_se }: InputNoise) -> Self {
        Self { sd, share, largest_shift, largest_shift_se }
    }
}

/// Another model on the held-out records.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Beside {
    /// The method.
    #[schemars(with = "Method")]
    pub method: String,
    /// Its fit on held-out records.
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub fit_percent: f64,
    /// That of the identified model on the same samples.
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub own_fit_percent: f64,
    /// Mean excess of the own squared error, as a share of the output's variance, and its 95 % interval.
    pub excess: Option<[f64; 3]>,
}

/// The model that could run in real time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Causal {
    /// Order.
    pub order: usize,
    /// Delay, samples.
    pub delay: isize,
    /// `a₁…aₙ`.
    #[serde(deserialize_with = "crate::input::nullable::numbers")]
    pub a: Vec<f64>,
    /// `b₁…bₙ`.
    #[serde(deserialize_with = "crate::input::nullable::numbers")]
    pub b: Vec<f64>,
    /// Its fit on held-out records.
    pub held_out: Option<Beside>,
}

/// The distance between the borders.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Loop {
    /// Share of the stroke over which the borders differ beyond their errors.
    #[serde(deserialize_with = "crate::input::nullable::number")]
    #[schemars(range(min = 0, max = 1))]
    #[serde(rename = "told_apart")]
    pub distinguished: f64,
    /// Where they differ most clearly.
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub clearest_v: f64,
    /// By how much.
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub difference: f64,
    /// Its standard error.
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub se: f64,
    /// In standard errors.
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub z: f64,
    /// From which value on that is beyond chance.
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub limit: f64,
}

/// One-step errors of the fit records.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Innovations {
    /// Share of the variance of the innovations that their past predicts.
    #[serde(deserialize_with = "crate::input::nullable::number")]
    #[serde(rename = "foretold")]
    pub forecast: f64,
    /// Ljung–Box statistic.
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub ljung_box: f64,
    /// Its p-value.
    #[serde(deserialize_with = "crate::input::nullable::number")]
    #[schemars(range(min = 0, max = 1))]
    pub p_value: f64,
    /// Lags.
    pub lags: usize,
}

impl From<&Baseline> for Beside {
    fn from(baseline: &Baseline) -> Self {
        Self {
            method: baseline.method.name().to_owned(),
            fit_percent: baseline.fit_percent,
            own_fit_percent: baseline.own_fit_percent,
            excess: baseline.excess.map(|e| [e.mean, e.low, e.high]),
        }
    }
}

impl From<BorderDistance> for Loop {
    fn from(distance: BorderDistance) -> Self {
        let BorderDistance { clearest, z, limit, distinguished, .. } = distance;
        Self {
            distinguished,
            clearest_v: clearest.v,
            difference: clearest.difference,
            se: clearest.se,
            z,
            limit,
        }
    }
}

/// A point of a border.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Point {
    /// Position, input units.
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub v: f64,
    /// The curve there, in the normalisation `u_M − u_m = 1`.
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub f: f64,
    /// Its standard error.
    #[serde(deserialize_with = "crate::input::nullable::number")]
    #[schemars(with = "Option<f64>", range(min = 0))]
    pub se: f64,
}

/// The free run of a record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RecordFit {
    /// Its name.
    pub name: String,
    /// What it is for.
    #[schemars(extend("enum" = ["fit", "holdout"]))]
    pub r#use: String,
    /// Its samples.
    pub samples: usize,
    /// Fit in free run.
    pub fit_percent: Option<f64>,
}

/// `{record: fit %}` in the order of the rig.
#[derive(Debug, Clone, PartialEq)]
pub struct FitByRecord(Vec<(String, Option<f64>)>);

impl Serialize for FitByRecord {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (record, fit) in &self.0 {
            map.serialize_entry(record, fit)?;
        }
        map.end()
    }
}

impl<'de> Deserialize<'de> for FitByRecord {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Entries;
        impl<'de> Visitor<'de> for Entries {
            type Value = FitByRecord;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<FitByRecord, A::Error> {
                let mut fits = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    fits.push(entry);
                }
                Ok(FitByRecord(fits))
            }
        }
        deserializer.deserialize_map(Entries)
    }
}

impl EstimateFile {
    /// The object of an identification.
    pub fn of(rig: &Rig, identification: &Identification) -> Self {
        let Identification { estimate, level_errors, examination, .. } = identification;
        let records: Vec<RecordFit> = {
            rig.records
                .iter()
                .zip(&identification.runs)
                .map(|(record, run)| RecordFit {
                    name: record.name.clone(),
                    r#use: record.usage.name().to_owned(),
                    samples: record.record.len(),
                    fit_percent: run.as_ref().map(|run| run.fit_percent),
                })
                .collect()
        };
        let fits = records.iter().map(|record| (record.name.clone(), record.fit_percent)).collect();
        Self {
            rig: rig.name.clone(),
            input: rig.input_label.clone(),
            output: rig.output_label.clone(),
            sample_time: rig.sample_time,
            method: identification.method.name().to_owned(),
            order: estimate.a.len(),
            delay: estimate.delay,
            a: estimate.a.clone(),
            a_se: estimate.a_se.clone(),
            b: estimate.b.clone(),
            b_se: estimate.b_se.clone(),
            noise_sd: estimate.noise_sd,
            gain: estimate.gain,
            gain_se: level_errors.map(|e| e.gain),
            y_high: estimate.y_high,
            y_high_se: level_errors.map(|e| e.y_high),
            y_low: estimate.y_low,
            y_low_se: level_errors.map(|e| e.y_low),
            descendant: points(&estimate.descending),
            ascendant: points(&estimate.ascending),
            fit_percent: FitByRecord(fits),
            excitation: estimate.excitation,
            samples: estimate.samples,
            records,
            causal: identification.obstacles.is_empty(),
            causal_alternative: examination.causal.as_ref().map(causal),
            baselines: examination.baselines.iter().map(Beside::from).collect(),
            r#loop: identification.distance.map(Loop::from),
            input_noise: identification.input_noise.map(Moved::from),
            innovations: examination.innovations.map(|w| Innovations {
                forecast: w.forecast,
                ljung_box: w.ljung_box,
                p_value: w.p_value,
                lags: w.lags,
            }),
            warnings: identification.flags.iter().map(|flag| flag.text.to_string()).collect(),
            flags: identification.flags.iter().map(reservation).collect(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
        }
    }
}

/// The JSON Schema of [`json`].
pub fn schema() -> Schema {
    stamped_schema::<EstimateFile>(SCHEMA)
}

/// One JSON object, indented, with a newline at its end.
pub fn json(rig: &Rig, identification: &Identification) -> String {
    stamped(SCHEMA, &EstimateFile::of(rig, identification))
}

fn reservation(flag: &Flag) -> Reservation {
    Reservation { kind: flag.kind.to_owned(), figure: flag.figure, text: flag.text.to_string() }
}

fn causal(alternative: &CausalAlternative) -> Causal {
    let estimate = &alternative.identification.estimate;
    Causal {
        order: estimate.a.len(),
        delay: estimate.delay,
        a: estimate.a.clone(),
        b: estimate.b.clone(),
        held_out: alternative.held_out.as_ref().map(Beside::from),
    }
}

fn points(border: &[BorderPoint]) -> Vec<Point> {
    border.iter().map(|point| Point { v: point.v, f: point.f, se: point.se }).collect()
}
