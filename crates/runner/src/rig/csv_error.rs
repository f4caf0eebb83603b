//! What can be wrong in a record's CSV file.

use miette::Diagnostic;
use std::fmt::{self, Display};
use thiserror::Error;

/// Something in a CSV file is wrong: file, line, what, and the remedy.
#[derive(Debug, Error)]
pub struct CsvError {
    /// The file.
    pub path: String,
    /// Line of the file, from 1; the header is line 1 unless blank lines come before it.
    pub line: Option<u64>,
    /// What is wrong there.
    pub problem: CsvProblem,
}

/// What is wrong in a CSV file.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
#[allow(missing_docs, reason = "the messages explain the fields")]
pub enum CsvProblem {
    #[error("the file is empty")]
    Empty,
    #[error("there is no column `{column}`; the header reads `{header}`")]
    MissingColumn { column: &'static str, header: String },
    #[error("column y is missing: play v and add the measured y")]
    NotMeasured,
    #[error("the column `{column}` stands twice in the header")]
    DuplicateColumn { column: &'static str },
    #[error("the column `{found}` is not known, but looks like `{meant}`")]
    LookAlike { found: String, meant: &'static str },
    #[error("the row has {found} cells, the header {expected}")]
    Ragged { found: usize, expected: usize },
    #[error("column `{column}`: the cell is empty")]
    EmptyCell { column: &'static str },
    #[error("column `{column}`: `{cell}` is not a number")]
    NotANumber { column: &'static str, cell: String },
    #[error("column `{column}`: `{cell}` is not finite")]
    NotFinite { column: &'static str, cell: String },
    #[error("column `t`: the time stamp {now} does not lie after the one before it, {before}")]
    NotIncreasing { before: f64, now: f64 },
    #[error(
        "column `t`: {before} is followed by {now}, {step} s later, but the sample time is {sample_time} s"
    )]
    Gap { before: f64, now: f64, step: f64, sample_time: f64 },
    #[error(
        "column `t`: the time stamps advance by {mean_step} s on average, but the sample time is {sample_time} s"
    )]
    OtherSampleTime { mean_step: f64, sample_time: f64 },
    #[error("the record has {found} samples; at least {needed} are needed")]
    TooShort { found: usize, needed: usize },
    #[error("the quoting is broken: {message}")]
    Unparsable { message: String },
}

impl CsvProblem {
    /// What the user can do about it.
    pub fn remedy(&self) -> String {
        match self {
            Self::Empty => "a record starts with the header `t,v,y` and has one row a sample".to_owned(),
            Self::NotMeasured => {
                "this is an input to be played: write the output measured at each sample into a third column, `t,v,y`"
                    .to_owned()
            }
            Self::MissingColumn { header, .. } if header.contains([';', '\t']) => {
                "separate the columns by commas, and write decimals with a point".to_owned()
            }
            Self::MissingColumn { column, header } if header.parse::<f64>().is_ok() || starts_with_number(header) => {
                format!("the first line must be a header that names the columns, `{column}` among them: `t,v,y`")
            }
            Self::MissingColumn { column, .. } => {
                format!("name the columns `t` (s), `v` (input), `y` (output): `{column}` is missing; case matters")
            }
            Self::DuplicateColumn { .. } => "remove or rename one of the two".to_owned(),
            Self::LookAlike { meant, .. } => {
                format!("write `{meant}` if that is meant, else give the column another name")
            }
            Self::Ragged { .. } => {
                "give every row one cell a column; a decimal comma would split a number in two".to_owned()
            }
            Self::EmptyCell { column: "y_sim" } => {
                "a prediction must cover every sample: fill the gap, or leave the column y_sim out".to_owned()
            }
            Self::EmptyCell { .. } | Self::NotANumber { .. } | Self::NotFinite { .. } => {
                "write a finite number with a decimal point; where samples are missing, split the record into two files"
                    .to_owned()
            }
            Self::NotIncreasing { .. } => "sort the rows by time and remove repeated ones".to_owned(),
            Self::Gap { .. } => "samples must be evenly spaced: fill the gap by interpolation, or split the record into two files there".to_owned(),
            Self::OtherSampleTime { mean_step, .. } => {
                format!("write `sample_time = {mean_step}` in the rig file, or resample the record")
            }
            Self::TooShort { .. } => {
                "take a longer record; the fit needs more samples than there are coefficients".to_owned()
            }
            Self::Unparsable { .. } => "write plain numbers, without quotation marks".to_owned(),
        }
    }
}

fn starts_with_number(header: &str) -> bool {
    header.split(',').next().is_some_and(|cell| cell.trim().parse::<f64>().is_ok())
}

impl Display for CsvError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            Some(line) => write!(f, "{}:{line}: {}", self.path, self.problem),
            None => write!(f, "{}: {}", self.path, self.problem),
        }
    }
}

impl Diagnostic for CsvError {
    fn help<'a>(&'a self) -> Option<Box<dyn Display + 'a>> {
        Some(Box::new(self.problem.remedy()))
    }
}
