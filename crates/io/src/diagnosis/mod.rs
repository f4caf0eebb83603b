//! A diagnosis as a command: which model meets which records, the run, and the result as JSON, words and a CSV.
//!
//! The diagnosis itself is the crate `switchback_diagnose`; here are files, threads and units.

mod error;
mod examine;
mod expectation;
mod experiment;
mod given;
mod model_file;
mod number;
mod parameter;
mod subject;
mod units;

pub use crate::model::ModelError;
pub use error::DiagnosisError;
pub use examine::{Report, examine, examine_watched};
pub use expectation::{Checked, Expectation};
pub use experiment::{NEXT_EXPERIMENT, next_experiment, separates};
pub use given::GivenModel;
pub use number::{closed_percent, digits, edge, fit_percent, whole_percent, with_interval};
pub use parameter::{Told, told};
pub use subject::{Source, Subject, SubjectError, met_by};
pub use units::Units;
