//! What to make a rig of, whoever said it: a rig file or the command line.

use std::path::PathBuf;
use switchback_estimator::hysteresis::Interval;
use switchback_estimator::rig::{Role, Usage};

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

/// How rows become samples.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Sampling {
    /// Seconds between samples, where the user gave it; else the time column tells it.
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
    /// Who said it, so that remedies are told in the same terms.
    pub voice: Voice,
}

/// One file of a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedRecord {
    /// Where it lies.
    pub path: PathBuf,
    /// The same as the user wrote it.
    pub named: String,
    /// What drove the input.
    pub role: Role,
    /// What the record, or its first part, is for.
    pub usage: Usage,
    /// Share of it, at its end, that is held out.
    pub held_out: Option<f64>,
}

/// How the plan was given.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Voice {
    /// By a rig file.
    Manifest,
    /// On the command line, which so far reads as this.
    CommandLine(String),
}

impl Voice {
    /// What to write to name columns.
    pub(super) fn naming(&self, wanted: &[(&str, String)]) -> String {
        match self {
            Self::Manifest => {
                let keys: Vec<_> = wanted.iter().map(|(key, name)| format!("{key} = {name:?}")).collect();
                format!("name them in the rig file: `columns = {{ {} }}`", keys.join(", "))
            }
            Self::CommandLine(command) => {
                let flags: Vec<_> =
                    wanted.iter().map(|(key, name)| format!("--{key} {}", in_shell(name))).collect();
                format!("name them, for instance: `{command} {}`", flags.join(" "))
            }
        }
    }
}

/// A word as a shell takes it.
pub(crate) fn in_shell(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "._-/+:".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}
