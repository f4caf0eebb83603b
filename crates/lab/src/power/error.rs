//! Why no power could be measured.

use crate::generate::InjectionError;
use miette::Diagnostic;
use switchback_io::diagnosis::{DiagnosisError, SubjectError};
use thiserror::Error;

/// What was refused, and what to do about it.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum PowerError {
    /// There is no model that could run on records with a fault.
    #[error("{data}: the columns y_sim predict these records only, not the same with a fault")]
    #[diagnostic(help(
        "give the model itself with `--model MODEL.json`, or leave the columns y_sim out to have one identified"
    ))]
    Predicted {
        /// The data.
        data: String,
    },
    /// The records are no ground for a fault.
    #[error("{data}: {error}")]
    #[diagnostic(help(
        "faults are put into records of a machine with a loop, at least one to fit, longer than a few time constants, and better one held out; \
         `switchback identify` shows what the records show"
    ))]
    Context {
        /// The data.
        data: String,
        /// What is wrong.
        error: InjectionError,
    },
    /// Records drawn anew cannot be used.
    #[error("{data}: records with residuals drawn anew cannot be used: {reason}")]
    #[diagnostic(help("record longer, or give a model that follows the records"))]
    Drawn {
        /// The data.
        data: String,
        /// What is wrong.
        reason: String,
    },
    /// Too many faults an effect, or none.
    #[error("{0} faults an effect cannot be put in")]
    #[diagnostic(help("give `--draws` from 1 to 1000"))]
    Draws(usize),
    /// All effects are left out.
    #[error("--power has no effect left to put in")]
    #[diagnostic(help("name some with `--effects`, or leave fewer out with `--without`"))]
    NoEffect,
    /// The model cannot meet the records.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Model(#[from] SubjectError),
    /// Not even records without a fault can be diagnosed.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Diagnosis(#[from] DiagnosisError),
}
