//! The CSV file of an input to run a model on.

use crate::input::{FileError, read_text};
use csv::{ReaderBuilder, Trim};
use miette::Diagnostic;
use std::path::Path;
use thiserror::Error;

/// An input on which a model runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Input {
    /// Time stamps, as they stand in the file.
    pub t: Vec<f64>,
    /// The input.
    pub v: Vec<f64>,
    /// The measured output, where the file has one.
    pub y: Option<Vec<f64>>,
}

/// Why a file is no input.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum InputError {
    /// The file cannot be read as text.
    #[error(transparent)]
    #[diagnostic(transparent)]
    File(#[from] FileError),
    /// Its content is refused.
    #[error("{place}: {message}")]
    #[diagnostic(help("{remedy}"))]
    Content {
        /// The file, with the line where it is known.
        place: String,
        /// What is wrong.
        message: String,
        /// What to do about it.
        remedy: String,
    },
}

const NAMES: [&str; 3] = ["t", "v", "y"];
/// Share of the sample time by which the typical step may be off: jitter and rounded stamps stay below it.
const OFF: f64 = 0.01;

/// Reads the columns `t`, `v` and, if there, `y`; other columns are ignored. The samples must be evenly spaced, by the model's sample time.
///
/// # Errors
/// [`InputError`] with the line and the remedy.
pub fn read_input(path: &Path, sample_time: f64) -> Result<Input, InputError> {
    let text = read_text(path)?;
    let fail = |line: Option<u64>, message: String, remedy: &str| InputError::Content {
        place: line.map_or(path.display().to_string(), |line| format!("{}:{line}", path.display())),
        message,
        remedy: remedy.to_owned(),
    };
    let mut reader = ReaderBuilder::new().flexible(true).trim(Trim::All).from_reader(text.as_bytes());
    let header = reader.headers().cloned().unwrap_or_default();
    let position = |name: &str| header.iter().position(|found| found == name);
    let positions = NAMES.map(position);
    if let Some(missing) = (0..2).find(|&k| positions[k].is_none()) {
        let shown = header.iter().collect::<Vec<_>>().join(",");
        let message = format!("there is no column `{}`; the header reads `{shown}`", NAMES[missing]);
        return Err(fail(
            None,
            message,
            "name the columns `t` (s), `v` (input) and, if it was measured, `y` (output)",
        ));
    }
    let mut columns: [Vec<f64>; 3] = Default::default();
    let mut lines = Vec::new();
    for row in reader.records() {
        let row = row.map_err(|error| {
            fail(
                error.position().map(csv::Position::line),
                error.to_string(),
                "write plain numbers, without quotation marks",
            )
        })?;
        let line = row.position().map(csv::Position::line);
        for ((name, position), column) in NAMES.iter().zip(positions).zip(&mut columns) {
            let Some(position) = position else { continue };
            let cell = row.get(position).unwrap_or_default();
            let number = cell.parse::<f64>().ok().filter(|x| x.is_finite()).ok_or_else(|| {
                let message = format!("column `{name}`: `{cell}` is not a finite number");
                fail(line, message, "write a finite number with a decimal point in every row; where samples are missing, split the file")
            })?;
            column.push(number);
        }
        lines.push(line);
    }
    let [t, v, y] = columns;
    if t.len() < 2 {
        return Err(fail(
            None,
            format!("the file has {} samples", t.len()),
            "give two at least, one a row below the header",
        ));
    }
    check_time(&t, sample_time)
        .map_err(|(index, message, remedy)| fail(index.and_then(|k| lines[k]), message, &remedy))?;
    Ok(Input { t, v, y: positions[2].map(|_| y) })
}

/// Index, message and remedy of what is wrong with time stamps.
type Uneven = (Option<usize>, String, String);

fn check_time(t: &[f64], sample_time: f64) -> Result<(), Uneven> {
    let mut steps: Vec<f64> = t.windows(2).map(|w| w[1] - w[0]).collect();
    if let Some(k) = steps.iter().position(|step| *step <= 0.0) {
        let message = format!("the time stamp {} does not lie after the one before it, {}", t[k + 1], t[k]);
        return Err((Some(k + 1), message, "sort the rows by time and remove repeated ones".to_owned()));
    }
    let uneven = steps.iter().position(|step| (step - sample_time).abs() >= 0.5 * sample_time);
    let first = uneven.map(|k| k + 1);
    let mean = (t[t.len() - 1] - t[0]) / steps.len() as f64;
    steps.sort_by(f64::total_cmp);
    let typical = steps[steps.len() / 2];
    let is_off = |step: f64| (step - sample_time).abs() > OFF * sample_time;
    // Stamps may be rounded: the mean step then tells the sample time better than any one does.
    if is_off(typical) && is_off(mean) {
        let found: f64 = format!("{mean:.5e}").parse().unwrap_or(mean);
        return Err((
            None,
            format!("the samples are {found} s apart, but the model's are {sample_time} s"),
            format!(
                "resample the input to {sample_time} s, or identify the model from records sampled every {found} s"
            ),
        ));
    }
    if let Some(k) = first {
        let message = format!("{} is followed by {}, but the sample time is {sample_time} s", t[k - 1], t[k]);
        let remedy = "samples must be evenly spaced: fill the gap by interpolation, or split the file there";
        return Err((Some(k), message, remedy.to_owned()));
    }
    Ok(())
}
