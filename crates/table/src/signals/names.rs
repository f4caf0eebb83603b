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
    /// Bring uneven rows to even steps, and slow signals to the rows of the output, in this way; else only where nothing is in doubt.
    pub resample: Option<Between>,
}

/// A signal between two of its values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Between {
    /// The value before.
    Hold,
    /// On the straight line.
    Linear,
}

impl Between {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Linear, Self::Hold];

    /// By its name on the command line and in rig files.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|between| between.name() == name)
    }

    /// `hold` or `linear`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Hold => "hold",
            Self::Linear => "linear",
        }
    }
}
