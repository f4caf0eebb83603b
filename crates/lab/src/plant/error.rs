//! Why nothing was planted.

use crate::generate::{InjectionError, RecipeError};
use miette::Diagnostic;
use switchback_io::model::UnitError;
use thiserror::Error;

/// Why nothing was planted.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum PlantError {
    /// The records are no ground for a fault.
    #[error("{data}: {error}")]
    #[diagnostic(help(
        "faults are planted into records of a machine with a loop, at least one to fit and better one held out; `switchback identify` shows what \
         the records show"
    ))]
    Context {
        /// The data.
        data: String,
        /// What is wrong.
        error: InjectionError,
    },
    /// The model is of another form.
    #[error("{model}: a model of the form `{kind}` cannot carry a fault")]
    #[diagnostic(help(
        "make one with `switchback identify --method free --out DIR`, or leave `--model` out"
    ))]
    Model {
        /// The model file.
        model: String,
        /// Its form.
        kind: &'static str,
    },
    /// The model is of records that are sampled otherwise.
    #[error("{model}: the model was identified at {at} s a sample, these records have {rig} s")]
    #[diagnostic(help(
        "identify the model from records that are sampled as these are, or leave `--model` out"
    ))]
    SampleTime {
        /// The model file.
        model: String,
        /// Seconds between its samples.
        at: f64,
        /// Seconds between those of the records.
        rig: f64,
    },
    /// There is no such fault.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Recipe(#[from] RecipeError),
    /// The model is of a machine that is measured in other units.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Unit(#[from] UnitError),
}
