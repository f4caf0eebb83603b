//! A diagnosis as a command: which model meets which records, the run, and the result as JSON, words and a CSV.
//!
//! The diagnosis itself is the crate `switchback_gap`; here are files, threads, units and sentences.

mod error;
mod examine;
mod expectation;
mod experiment;
mod given;
pub(crate) mod json;
mod model_file;
mod number;
mod parameter;
mod place;
mod sentences;
mod subject;
mod units;
mod why;
mod words;

pub use crate::model::ModelError;
pub use error::DiagnosisError;
pub use examine::{Report, examine, examine_watched};
pub use expectation::{Checked, Expectation};
pub use experiment::{NEXT_EXPERIMENT, next_experiment};
pub use given::GivenModel;
pub use json::json;
pub use number::{closed_percent, digits, fit_percent};
pub use parameter::{Told, told};
pub use place::SIGNIFICANT;
pub(crate) use sentences::probability;
pub use subject::{Source, Subject, SubjectError, met_by};
pub use units::Units;
pub use why::why;
pub(crate) use words::wrapped;
pub use words::{verdict, words};
