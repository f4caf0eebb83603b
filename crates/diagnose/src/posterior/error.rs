//! Why a posterior cannot be used.

use thiserror::Error;

/// Why a posterior cannot be used.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum PosteriorError {
    /// The file is not one of a posterior.
    #[error("the file holds no posterior: it does not begin with SWBP; train one with `switchback train`")]
    NoPosterior,
    /// The file is of another version.
    #[error("the posterior has version {found}, this program reads version {known}; train it anew")]
    Version {
        /// Of the file.
        found: u32,
        /// Of this program.
        known: u32,
    },
    /// The file ends too early, goes on too long, or holds what cannot be.
    #[error("the posterior is damaged at byte {at}: {what}; take it from its source again")]
    Damaged {
        /// Position in the file.
        at: usize,
        /// What is wrong.
        what: &'static str,
    },
    /// A column is missing.
    #[error(
        "the evidence lacks the column `{0}` that the posterior was trained with; train it anew with this program"
    )]
    MissingColumn(String),
    /// A column is there that the posterior does not know.
    #[error(
        "the evidence has a column `{0}` that the posterior was not trained with; train it anew with this program"
    )]
    UnknownColumn(String),
    /// A value is not finite.
    #[error("the evidence `{column}` is {value}; every column must be finite")]
    NotFinite {
        /// The column.
        column: String,
        /// Its value.
        value: f64,
    },
    /// The posterior was not recalibrated for a population.
    #[error("the posterior is not calibrated for the population `{name}`; known are {known}")]
    UnknownPopulation {
        /// The name asked for.
        name: String,
        /// Known names, comma-separated.
        known: String,
    },
}
