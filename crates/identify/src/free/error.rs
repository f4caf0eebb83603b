//! Why an identification fails.

use thiserror::Error;

/// Why nothing could be identified from the records.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum FreeError {
    /// There is nothing to identify from.
    #[error("no record to identify from; mark at least one record `use = \"fit\"`")]
    NoRecords,
    /// The input of every record stands still, within the reversal threshold.
    #[error(
        "the input never moves by more than the reversal threshold {threshold}; drive it, or lower the threshold"
    )]
    NoMotion {
        /// The threshold in force, input units.
        threshold: f64,
    },
    /// The output of the records is constant.
    #[error("the output is constant; nothing can be identified from it")]
    ConstantOutput,
    /// A setting is outside its range.
    #[error("{name} is {value}; it must be {allowed}")]
    Setting {
        /// Which setting.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// The records are too short for the number of parameters.
    #[error(
        "{samples} usable samples for {parameters} parameters; give longer records, fewer knots or a lower order"
    )]
    TooShort {
        /// Samples that a regression could use.
        samples: usize,
        /// Parameters to be estimated.
        parameters: usize,
    },
    /// No stable model fits.
    #[error(
        "no stable model of order {order} fits the records; try another order or delay, or check the records for drift"
    )]
    Unstable {
        /// The order tried last.
        order: usize,
    },
    /// A knot has no data around it.
    #[error(
        "no sample of the {curve} border lies near its knot {v}; give fewer knots, or a narrower interval"
    )]
    UnvisitedKnot {
        /// `ascending` or `descending`.
        curve: &'static str,
        /// Position of the knot, input units.
        v: f64,
    },
    /// The input ends before the samples asked for.
    #[error(
        "the input leaves {available} regression samples where {wanted} are asked for; give a longer one"
    )]
    InputTooShort {
        /// Samples that can be explained.
        available: usize,
        /// Samples of the last checkpoint.
        wanted: usize,
    },
    /// A parameter has no information even with noise-free data.
    #[error("the input leaves a parameter open; drive it over more of its range, or give fewer knots")]
    NotExcited,
}
