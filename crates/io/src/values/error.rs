//! What to give in place of a value that is none.

use switchback_model::hysteresis::IntervalError;
use thiserror::Error;

/// A value that an option cannot have.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ValueError {
    /// No finite number.
    #[error("give a number")]
    Number,
    /// No finite number above zero.
    #[error("give a positive number")]
    Positive,
    /// No whole number of at least this.
    #[error("give a whole number, {low} or more")]
    AtLeast {
        /// The smallest allowed.
        low: u64,
    },
    /// No whole number within these limits.
    #[error("give a whole number from {low} to {high}")]
    Within {
        /// The smallest allowed.
        low: u64,
        /// The largest allowed.
        high: u64,
    },
    /// Something between commas that is no number.
    #[error("`{part}` is no number")]
    Part {
        /// What was given.
        part: String,
    },
    /// Another count of numbers than two.
    #[error("give two numbers with a comma between them, as in -40,40")]
    Pair,
    /// Two numbers that are no interval.
    #[error(transparent)]
    Interval(#[from] IntervalError),
}
