//! What to make a rig of, whoever said it: a rig file or the command line.

use std::path::PathBuf;
use switchback_model::hysteresis::Interval;
use switchback_model::rig::{Role, Usage};
use switchback_table::signals::{ColumnNames, InputForm, Sampling};

/// Share of a single record that is held out where nothing else was said: its last third.
pub const HELD_OUT: f64 = 1.0 / 3.0;

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
