//! The input that a model is to run on.

use super::SimulateError;
use std::path::{Path, PathBuf};
use switchback_io::input::{DataError, DataProblem};
use switchback_io::model::ModelFile;
use switchback_io::rig::{Between, ColumnNames, InputSeries, RigError, RigProblem, Sampling, read_input};

/// A file that holds the input, and how to read it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Request {
    /// The file: one column at least.
    pub file: PathBuf,
    /// Names of columns. With a measured output the run begins where the record does.
    pub columns: ColumnNames,
    /// Bring the rows to the model's sample time in this way.
    pub resample: Option<Between>,
}

impl Request {
    /// Reads the input, at the sample time of a model, which messages call by its path.
    ///
    /// # Errors
    /// A file that is no input, or one that is sampled otherwise.
    pub fn read(&self, (file, model): (&ModelFile, &Path)) -> Result<InputSeries, SimulateError> {
        let sample_time = file.header.sample_time;
        let sampling = Sampling { sample_time: Some(sample_time), resample: self.resample };
        let input = self.file.display().to_string();
        let command = format!("switchback simulate {} {input}", model.display());
        read_input(&self.file, &self.columns, sampling, &command).map_err(|error| match step(&error) {
            Some(found) => SimulateError::SampleTime { input, found, model: sample_time },
            None => error.into(),
        })
    }
}

/// Seconds between samples, where they are not those of the model.
fn step(error: &RigError) -> Option<f64> {
    error.problems().find_map(|problem| match problem {
        RigProblem::Data(DataError { problem: DataProblem::OtherSampleTime { mean_step, .. }, .. }) => {
            Some(*mean_step)
        }
        _ => None,
    })
}
