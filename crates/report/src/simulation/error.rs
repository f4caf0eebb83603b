//! Why a model did not run.

use miette::Diagnostic;
use switchback_io::model::UnitError;
use switchback_io::rig::RigError;
use thiserror::Error;

/// Why a model did not run.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum SimulateError {
    /// The model knows no border for the input.
    #[error("{input}: the input runs along a border that the model does not know")]
    #[diagnostic(help("identify the model from records that run on both borders, or with `--method free`"))]
    NoRun {
        /// The input file.
        input: String,
    },
    /// The input is sampled otherwise.
    #[error("{input}: the samples are {found} s apart, but the model was identified at {model} s")]
    #[diagnostic(help("sample the input as the model was, or add `--resample` to interpolate it linearly"))]
    SampleTime {
        /// The input file.
        input: String,
        /// Seconds between its samples.
        found: f64,
        /// Seconds between those of the model.
        model: f64,
    },
    /// The input cannot be read.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Input(#[from] RigError),
    /// The input is measured in another unit.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Unit(#[from] UnitError),
}
