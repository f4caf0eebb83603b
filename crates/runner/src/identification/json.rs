//! The identification as one JSON object.

use super::{CausalAlternative, Flag, Identification, Yardstick};
use crate::output::stamped;
use serde::de::{MapAccess, Visitor};
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;
use switchback_estimator::estimators::free::InputNoise;
use switchback_estimator::estimators::{BorderDistance, BorderPoint};
use switchback_estimator::rig::Rig;

/// Name and version of the layout.
pub(crate) const SCHEMA: &str = "switchback/identify/1";

/// The object that `identify --json` prints; figures that do not exist are null.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct EstimateFile {
    pub(crate) rig: String,
    pub(crate) input: String,
    pub(crate) output: String,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) sample_time: f64,
    pub(crate) method: String,
    pub(crate) order: usize,
    pub(crate) delay: isize,
    #[serde(deserialize_with = "crate::input::nullable::numbers")]
    pub(crate) a: Vec<f64>,
    #[serde(deserialize_with = "crate::input::nullable::numbers")]
    pub(crate) a_se: Vec<f64>,
    #[serde(deserialize_with = "crate::input::nullable::numbers")]
    pub(crate) b: Vec<f64>,
    #[serde(deserialize_with = "crate::input::nullable::numbers")]
    pub(crate) b_se: Vec<f64>,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) noise_sd: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) gain: f64,
    pub(crate) gain_se: Option<f64>,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) y_high: f64,
    pub(crate) y_high_se: Option<f64>,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) y_low: f64,
    pub(crate) y_low_se: Option<f64>,
    pub(crate) descendant: Vec<Point>,
    pub(crate) ascendant: Vec<Point>,
    pub(crate) fit_percent: FitByRecord,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) excitation: f64,
    pub(crate) samples: usize,
    pub(crate) records: Vec<RecordFit>,
    /// Whether the model could run in real time.
    pub(crate) causal: bool,
    /// The best model that could, where this one could not.
    pub(crate) causal_alternative: Option<Causal>,
    pub(crate) yardsticks: Vec<Beside>,
    /// How far the borders lie apart.
    pub(crate) r#loop: Option<Loop>,
    /// What noise on the input does to the estimate.
    pub(crate) input_noise: Option<Moved>,
    pub(crate) innovations: Option<Innovations>,
    /// The sentences of `flags`.
    pub(crate) warnings: Vec<String>,
    pub(crate) flags: Vec<Reservation>,
    pub(crate) version: String,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Reservation {
    pub(crate) kind: String,
    pub(crate) figure: Option<f64>,
    pub(crate) text: String,
}

/// By how much noise on the input moves the estimate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Moved {
    pub(crate) sd: f64,
    pub(crate) share: f64,
    pub(crate) largest_shift: f64,
    pub(crate) largest_shift_se: f64,
}

impl From<InputNoise> for Moved {
    fn from(InputNoise { sd, share, largest_shift, largest_shift_se }: InputNoise) -> Self {
        Self { sd, share, largest_shift, largest_shift_se }
    }
}

/// Another model on the held-out records.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Beside {
    pub(crate) method: String,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) fit_percent: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) own_fit_percent: f64,
    /// Mean excess of the own squared error, as a share of the output's variance, and its 95 % interval.
    pub(crate) excess: Option<[f64; 3]>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Causal {
    pub(crate) order: usize,
    pub(crate) delay: isize,
    #[serde(deserialize_with = "crate::input::nullable::numbers")]
    pub(crate) a: Vec<f64>,
    #[serde(deserialize_with = "crate::input::nullable::numbers")]
    pub(crate) b: Vec<f64>,
    pub(crate) held_out: Option<Beside>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Loop {
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) told_apart: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) clearest_v: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) difference: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) se: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) z: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) limit: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Innovations {
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) foretold: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) ljung_box: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) p_value: f64,
    pub(crate) lags: usize,
}

impl From<&Yardstick> for Beside {
    fn from(yardstick: &Yardstick) -> Self {
        Self {
            method: yardstick.method.name().to_owned(),
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

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Point {
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) v: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) f: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) se: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RecordFit {
    pub(crate) name: String,
    pub(crate) r#use: String,
    pub(crate) samples: usize,
    pub(crate) fit_percent: Option<f64>,
}

/// `{record: fit %}` in the order of the rig.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FitByRecord(Vec<(String, Option<f64>)>);

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

/// One JSON object, indented, with a newline at its end.
pub fn json(rig: &Rig, identification: &Identification) -> String {
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
    let page = EstimateFile {
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
        yardsticks: examination.yardsticks.iter().map(Beside::from).collect(),
        r#loop: identification.distance.map(Loop::from),
        input_noise: identification.input_noise.map(Moved::from),
        innovations: examination.innovations.map(|w| Innovations {
            foretold: w.foretold,
            ljung_box: w.ljung_box,
            p_value: w.p_value,
            lags: w.lags,
        }),
        warnings: identification.flags.iter().map(|flag| flag.text.to_string()).collect(),
        flags: identification.flags.iter().map(reservation).collect(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
    };
    stamped(SCHEMA, &page)
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
