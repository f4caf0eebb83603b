//! Which columns are taken, and how rows become samples, where the user said so.

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
    pub fn or(&self, others: &Self) -> Self {
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
