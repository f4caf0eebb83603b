//! A rig: the records of one measuring dataset and what is known about them.

use crate::hysteresis::Interval;
use crate::record::Record;

/// What drove the input while a record was taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Role {
    /// The input is held at `h_M` after one move that loads the border.
    StepHigh,
    /// The input is held at `h_m` after one move that loads the border.
    StepLow,
    /// The descendant experiment (3.1): from the satellite `h_M`, visits to lower levels, one sample each.
    Descendant,
    /// The ascendant experiment (4.1): from the satellite `h_m`, visits to higher levels, one sample each.
    Ascendant,
    /// Any other input.
    Free,
}

impl Role {
    /// The word for it in a rig file.
    pub fn name(self) -> &'static str {
        match self {
            Self::StepHigh => "step_high",
            Self::StepLow => "step_low",
            Self::Descendant => "descendant",
            Self::Ascendant => "ascendant",
            Self::Free => "free",
        }
    }
}

/// Samples that a record must have for a linear part of this order, none where it is to be chosen.
///
/// Equations of order n reach back n samples and have 2n coefficients and at least two border values; one sample more leaves a residual. Ten at
/// the least, since no order at all can be chosen from fewer.
pub fn samples_needed(order: Option<usize>) -> usize {
    order.map_or(10, |n| (3 * n + 3).max(10))
}

/// What a record is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Usage {
    /// Models are identified from it.
    Fit,
    /// Models are judged on it; nothing is ever fitted to it.
    Holdout,
}

impl Usage {
    /// The word for it in a rig file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fit => "fit",
            Self::Holdout => "holdout",
        }
    }
}

/// One record of a rig.
#[derive(Debug, Clone, PartialEq)]
pub struct RigRecord {
    /// What the user calls it (the file's name without its ending).
    pub name: String,
    /// What drove the input.
    pub role: Role,
    /// Fit or hold-out.
    pub usage: Usage,
    /// The measured input and output.
    pub record: Record,
    /// Another simulator's prediction of `y`, one value a sample, to be diagnosed instead of a model identified here.
    pub predicted: Option<Vec<f64>>,
}

/// A dataset of records taken from one rig.
#[derive(Debug, Clone, PartialEq)]
pub struct Rig {
    /// The rig's name.
    pub name: String,
    /// Seconds between samples, positive.
    pub sample_time: f64,
    /// Order of the linear part, where the user knows it.
    pub order: Option<usize>,
    /// Working interval of the input, where the user knows it; else the range of the records.
    pub interval: Option<Interval>,
    /// Label and unit of the input, e.g. `displacement [mm]`.
    pub input_label: String,
    /// Label and unit of the output.
    pub output_label: String,
    /// The records, in the order of the file.
    pub records: Vec<RigRecord>,
}

impl Rig {
    /// The records that models are identified from.
    pub fn fit_records(&self) -> impl Iterator<Item = &RigRecord> {
        self.records.iter().filter(|r| r.usage == Usage::Fit)
    }

    /// The records that models are judged on.
    pub fn holdout_records(&self) -> impl Iterator<Item = &RigRecord> {
        self.records.iter().filter(|r| r.usage == Usage::Holdout)
    }
}
