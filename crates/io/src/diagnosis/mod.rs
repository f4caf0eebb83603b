//! A diagnosis as a command: which model meets which records, the run, and the result as JSON, words and a CSV.
//!
//! The diagnosis itself is the crate `switchback_diagnose`; here are files, threads and units.

mod choice;
mod difference;
mod error;
pub mod examine;
mod expectation;
mod experiment;
mod given;
mod model_file;
mod number;
mod parameter;
mod posterior;
mod prior;
mod request;
mod shift;
mod stability;
mod subject;
mod subsampling;
mod units;

pub use difference::ReportedDifference;
pub use error::DiagnosisError;
pub use examine::Report;
pub use examine::examine;
pub use examine::examine_watched;
pub use expectation::Checked;
pub use expectation::Expectation;
pub use experiment::NEXT_EXPERIMENT;
pub use experiment::next_experiment;
pub use experiment::separates;
pub use given::GivenModel;
pub use number::closed_percent;
pub use number::digits;
pub use number::edge;
pub use number::fit_percent;
pub use number::whole_percent;
pub use number::with_interval;
pub use parameter::Reported;
pub use parameter::reported;
pub use posterior::{NoPosterior, posterior};
pub use prior::NoPrior;
pub use prior::prior;
pub use request::Request;
pub use shift::{Estimate, Shift};
pub use stability::{PartVerdict, Stability};
pub use subject::Source;
pub use subject::Subject;
pub use subject::SubjectError;
pub use subject::met_by;
pub use subsampling::stability;
pub use units::Units;
