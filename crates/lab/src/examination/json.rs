//! What results.json of an examination holds: the same types write and read it. Keys stand in the order of the alphabet.

use super::calibration::CalibrationBin;
use super::measure::{Bound, Measure, Share};
use serde::{Deserialize, Serialize};

/// A measure, what it must reach, what it reached.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeasureFile {
    /// What the scenario wants of it.
    pub expected: Option<Bound>,
    /// Whether it is reported in percent.
    #[serde(default = "in_percent")]
    pub in_percent: bool,
    /// Its 95 % interval, where it is a share.
    pub interval: Option<[f64; 2]>,
    /// Its name in scenarios.
    pub key: String,
    /// What it measures.
    pub measure: String,
    /// Whether it reaches what it must.
    pub meets: Option<bool>,
    /// What it must reach.
    pub must_reach: Option<Bound>,
    /// The figure.
    pub reached: Option<f64>,
    /// Rigs behind it.
    pub rigs: usize,
}

fn in_percent() -> bool {
    true
}

/// A share: so many of so many.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShareFile {
    /// Those that hold.
    pub count: usize,
    /// All.
    pub of: usize,
    /// The one over the other; none of none.
    pub share: Option<f64>,
}

/// What was claimed with a probability, and how often it held.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BinFile {
    /// Mean probability claimed.
    pub claimed: f64,
    /// How often it held.
    pub held: ShareFile,
}

impl From<&Measure> for MeasureFile {
    fn from(measure: &Measure) -> Self {
        Self {
            expected: measure.expected,
            in_percent: measure.in_percent,
            interval: measure.interval,
            key: measure.key.to_owned(),
            measure: measure.text.to_owned(),
            meets: measure.meets_target(),
            must_reach: measure.target,
            reached: measure.reached,
            rigs: measure.rigs,
        }
    }
}

impl From<Share> for ShareFile {
    fn from(share: Share) -> Self {
        Self { count: share.count, of: share.of, share: share.value() }
    }
}

impl From<&CalibrationBin> for BinFile {
    fn from(bin: &CalibrationBin) -> Self {
        Self { claimed: bin.claimed, held: bin.held.into() }
    }
}
