//! One file as an input to be played: `v`, perhaps with a measured `y` beside it.

use super::problem::{RigError, RigProblem};
use std::path::Path;
use switchback_table::signals::{ColumnNames, InputForm, Measured, Request, Sampling, spikes};
use switchback_table::table::Column;

/// An evenly sampled input, and what was measured beside it.
#[derive(Debug, Clone, PartialEq)]
pub struct InputSeries {
    /// Seconds between samples, positive.
    pub sample_time: f64,
    /// Seconds of the first sample, where a time column shows it; else 0.
    pub start: f64,
    /// The input, at least one sample, finite.
    pub v: Vec<f64>,
    /// The time of every sample as it stands in the file, where it has one and no rows were interpolated.
    pub times: Option<Vec<String>>,
    /// The unit of these times where it is not the second.
    pub time_unit: Option<String>,
    /// The output, where the file has one; as many samples, NaN where none was measured.
    pub y: Option<Vec<f64>>,
    /// Name of the input's column, with its unit where the file gives one.
    pub input_label: String,
    /// Name of the output's column.
    pub output_label: Option<String>,
    /// Values that cannot have been measured, one sentence each.
    pub warnings: Vec<String>,
    /// How the file was read, where that is not how such files usually look.
    pub notes: Vec<String>,
}

/// Reads a file that holds an input: columns as in a rig's record, but the output may be missing.
///
/// An input that is to be played must be whole: a dropout is an error. `command` is the command line so far, for remedies.
///
/// # Errors
/// [`RigError`] with all that is wrong.
pub fn read_input(
    path: &Path,
    names: &ColumnNames,
    sampling: Sampling,
    command: &str,
) -> Result<InputSeries, RigError> {
    let input_form = InputForm::Simulation(command.to_owned());
    let request = Request { names, sampling, input_form: &input_form, needs_output: false };
    let measured = Measured::read(path, request)
        .map_err(|problems| RigError::new(problems.into_iter().map(RigProblem::from).collect()))?;
    if let Some(interruption) = measured.first_interruption() {
        return Err(interruption.into());
    }
    Ok(InputSeries {
        sample_time: measured.sample_time,
        start: measured.start,
        input_label: measured.input().label(),
        output_label: measured.output().map(Column::label),
        warnings: measured.doubts.iter().cloned().chain(spikes(&measured)).collect(),
        notes: measured.table.notes.clone(),
        times: measured.times(),
        time_unit: measured.time_unit(),
        v: measured.v,
        y: measured.y,
    })
}
