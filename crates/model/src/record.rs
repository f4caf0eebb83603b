//! A record: what an experiment on a rig leaves behind, and all an estimator may see.

use thiserror::Error;

/// Input `v` and output `y`, sampled at the same instants, one entry a sample.
///
/// Both have the same length, at least one sample, and finite entries.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    v: Vec<f64>,
    y: Vec<f64>,
}

/// Why a pair of signals is no record.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum RecordError {
    /// The two signals differ in length.
    #[error("the input has {v} samples and the output {y}; a record needs one of each at every instant")]
    LengthMismatch {
        /// Samples of the input.
        v: usize,
        /// Samples of the output.
        y: usize,
    },
    /// There is no sample at all.
    #[error("the record is empty; it needs at least one sample")]
    Empty,
    /// A sample is NaN or infinite.
    #[error("{signal} is {value} at sample {index}; every sample must be finite")]
    NotFinite {
        /// `v` or `y`.
        signal: &'static str,
        /// Position of the sample, from 0.
        index: usize,
        /// The offending value.
        value: f64,
    },
}

impl Record {
    /// Checks and joins an input and an output.
    ///
    /// # Errors
    /// [`RecordError`] if the lengths differ, the record is empty, or a sample is not finite.
    pub fn new(v: Vec<f64>, y: Vec<f64>) -> Result<Self, RecordError> {
        if v.len() != y.len() {
            return Err(RecordError::LengthMismatch { v: v.len(), y: y.len() });
        }
        if v.is_empty() {
            return Err(RecordError::Empty);
        }
        for (signal, values) in [("v", &v), ("y", &y)] {
            if let Some((index, &value)) = values.iter().enumerate().find(|(_, x)| !x.is_finite()) {
                return Err(RecordError::NotFinite { signal, index, value });
            }
        }
        Ok(Self { v, y })
    }

    /// The input, in its own units.
    pub fn v(&self) -> &[f64] {
        &self.v
    }

    /// The output, in its own units.
    pub fn y(&self) -> &[f64] {
        &self.y
    }

    /// Number of samples; never zero.
    #[allow(clippy::len_without_is_empty, reason = "a record is never empty")]
    pub fn len(&self) -> usize {
        self.v.len()
    }
}
