//! What to make a rig of, whoever said it: a rig file or the command line.

use super::input_form::InputForm;
use std::path::PathBuf;
use switchback_model::hysteresis::Interval;
use switchback_model::rig::{Role, Usage};

/// Share of a single record that is held out where nothing else was said: its last third.
pub const HELD_OUT: f64 = 1.0 / 3.0;

/// In place of a time column's name: the rows are evenly spaced, whatever columns there are.
pub const NO_TIME: &str = "none";

/// Names of columns, where the user gave them; the others are guessed from the header.
///
/// A name finds its column with or without the unit, in any case; a number is the column's position, from 1.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ColumnNames {
    /// The time column, or [`NO_TIME`].
    pub time: Option<String>,
    /// The input `v`.
    pub input: Option<String>,
    /// The output `y`.
    pub output: Option<String>,
}

impl ColumnNames {
    /// These names, and the others' where there is none.
    pub(super) fn or(&self, others: &Self) -> Self {
        let either = |own: &Option<String>, other: &Option<String>| own.clone().or_else(|| other.clone());
        Self {
            time: either(&self.time, &others.time),
            input: either(&self.input, &others.input),
            output: either(&self.output, &others.output),
        }
    }
}

/// How rows become samples.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Sampling {
    /// Seconds between samples, where the user gave it; else the time column shows it.
    pub sample_time: Option<f64>,
    /// Interpolate linearly to even steps.
    pub resample: bool,
}

/// What to make a rig of.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// The rig's name.
    pub name: String,
    /// Where columns are found.
    pub columns: ColumnNames,
    /// How rows become samples.
    pub sampling: Sampling,
    /// Order of the linear part, where known.
    pub order: Option<usize>,
    /// Working interval, where known.
    pub interval: Option<Interval>,
    /// Label and unit of the input, where they are not those of its column.
    pub input_label: Option<String>,
    /// Label and unit of the output.
    pub output_label: Option<String>,
    /// One a file.
    pub records: Vec<PlannedRecord>,
    /// Who said it, so that remedies are reported in the same terms.
    pub input_form: InputForm,
}

/// One file of a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedRecord {
    /// Where it lies.
    pub path: PathBuf,
    /// The same as the user wrote it.
    pub named: String,
    /// Names of its columns, where they are not those of the plan.
    pub columns: ColumnNames,
    /// What drove the input.
    pub role: Role,
    /// What the record, or its first part, is for.
    pub usage: Usage,
    /// Share of it, at its end, that is held out.
    pub held_out: Option<f64>,
}
