//! What can be wrong in a file of measurements.

use miette::Diagnostic;
use std::fmt::{self, Display};
use thiserror::Error;

/// Something in a file of measurements is wrong: file, place, what, and the remedy.
#[derive(Debug, Clone, PartialEq, Error)]
pub struct DataError {
    /// The file.
    pub path: String,
    /// Where in it.
    pub place: Option<Place>,
    /// What is wrong there.
    pub problem: DataProblem,
}

/// A place in a file of measurements.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// Line of a text file, from 1.
    Line(u64),
    /// Row of the arrays of a binary file, from 1.
    Row(u64),
}

/// What is wrong in a file of measurements.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
#[allow(missing_docs, reason = "the messages explain the fields")]
pub enum DataProblem {
    #[error("the file is empty")]
    Empty,
    #[error(
        "no table was found: there are no rows with numbers in at least two columns; line {line} is `{shown}`"
    )]
    NoTable { line: u64, shown: String },
    #[error("the file cannot be read as MATLAB data: {reason}")]
    NotMatlab { reason: String },
    #[error("the file cannot be read as a log in MCAP: {reason}")]
    NotLog { reason: String },
    #[error("the file cannot be read as a log in MDF 4: {reason}")]
    NotMdf { reason: String },
    #[error("the file cannot be read as a table in Parquet: {reason}")]
    NotParquet { reason: String },
    #[error("the header has {found} cells, the rows {expected}")]
    HeaderWidth { found: usize, expected: usize },
    #[error(
        "the comma separates columns and decimals both: the header has {found} cells, the rows {expected}"
    )]
    CommasTwice { found: usize, expected: usize },
    #[error("the row has {found} cells, but the table has {expected} columns")]
    Ragged { found: usize, expected: usize },
    #[error("there is no column `{asked}`; the columns are {known}")]
    UnknownColumn { asked: String, known: String, meant: Option<String> },
    #[error("the column `{column}` stands {times} times in the header")]
    DuplicateColumn { column: String, times: usize },
    #[error("the column `{column}` is asked for as {first} and as {second}")]
    SameColumn { column: String, first: &'static str, second: &'static str },
    #[error("the column `{found}` is not known, but looks like `{meant}`")]
    LookAlike { found: String, meant: &'static str },
    #[error("which column is {role} is ambiguous; the columns are {known}")]
    Doubtful { role: String, known: String, remedy: String },
    #[error("column y is missing: play {input} and add the measured y")]
    NotMeasured { input: String },
    #[error("column `{column}`: the cell is empty or NaN")]
    EmptyCell { column: String, remedy: String },
    #[error("the record is interrupted: samples are missing, or another record begins")]
    Interrupted { remedy: String },
    #[error("column `{column}`: `{cell}` is not a number")]
    NotANumber { column: String, cell: String },
    #[error("column `{column}`: the unit of `{cell}` is not that of the rows above")]
    OtherUnit { column: String, cell: String },
    #[error("column `{column}`: `{cell}` is not an ISO 8601 time as in the rows above")]
    NotAStamp { column: String, cell: String },
    #[error("column `{column}`: `{cell}` is not finite")]
    NotFinite { column: String, cell: String },
    #[error("column `{column}`: {count} more cells like this")]
    More { column: String, count: usize, remedy: String },
    #[error("column `{column}`: `{cell}` is no time that can be read")]
    NotATime { column: String, cell: String, remedy: String },
    #[error("column `{column}`: the decimal sign of `{cell}` is a {found}, but not that of other columns")]
    OtherDecimal { column: String, cell: String, found: &'static str },
    #[error("column `{}`: the time stamp {} does not lie after the one before it, {}", .0.column, .0.now, .0.before)]
    NotIncreasing(Box<Step>),
    #[error("column `{}`: its unit changes: from {} to {} on, steps of {} s become steps of {} s", .0.column, .0.before, .0.now, .0.sample_time, .0.step)]
    UnitChanges(Box<Step>),
    #[error("column `{}`: time starts anew: {} is followed by {}", .0.column, .0.before, .0.now)]
    StartsAnew(Box<Step>),
    #[error("column `{}`: {} is followed by {}, a step of {} s where the sample time is {} s", .0.column, .0.before, .0.now, .0.step, .0.sample_time)]
    Gap(Box<Step>),
    #[error("column `{}`: uneven sampling: {} is followed by {}, a step of {} s where the mean one is {} s", .0.column, .0.before, .0.now, .0.step, .0.sample_time)]
    Uneven(Box<Step>),
    #[error(
        "column `{column}`: the time stamps advance by {mean_step} s on average, but the sample time is {sample_time} s"
    )]
    OtherSampleTime { column: String, mean_step: f64, sample_time: f64, remedy: String },
    #[error("the sample time is not known: {reason}")]
    NoSampleTime { reason: String, remedy: String },
    #[error("the sample time is {here} s here, but {there} s in {other}")]
    SampleTimesDiffer { here: f64, there: f64, other: String, remedy: String },
    #[error("the column is `{here}` here, but `{there}` in {other}")]
    UnitsDiffer { here: String, there: String, other: String },
    #[error("the input `{column}` never moves, in this file nor in any other that is fitted")]
    NeverMoves { column: String },
    #[error("none of the columns ever moves: {columns}")]
    NothingMoves { columns: String },
    #[error("the output `{column}` never changes, in this file nor in any other that is fitted")]
    NeverChanges { column: String },
    #[error(
        "cut, the record leaves {} to fit and {held_out} held out; each side needs at least {needed} in one piece", samples(*fitted)
    )]
    CutTooShort { fitted: usize, held_out: usize, needed: usize, remedy: String },
    #[error("the record has {}; at least {needed} are needed", samples(*found))]
    TooShort { found: usize, needed: usize },
    #[error(
        "dropouts cut the {rows} rows into pieces so short that {left} rows are left in usable ones (of {needed} samples or more)"
    )]
    Shattered { rows: usize, left: usize, needed: usize, remedy: String },
}

/// From one time stamp to the next.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs, reason = "the messages explain the fields")]
pub struct Step {
    pub column: String,
    /// The stamps as they stand in the file.
    pub before: String,
    pub now: String,
    /// Seconds between them.
    pub step: f64,
    /// Seconds that were expected.
    pub sample_time: f64,
    pub remedy: String,
}

fn samples(count: usize) -> String {
    format!("{count} sample{}", if count == 1 { "" } else { "s" })
}

impl DataProblem {
    /// What the user can do about it.
    pub fn remedy(&self) -> String {
        match self {
            Self::Empty | Self::NoTable { .. } => {
                "a file of measurements has one row a sample, with the input and the output in two columns; commas, semicolons, tabs, bars or blanks between them".to_owned()
            }
            Self::NotMatlab { .. } => "save numeric vectors of one length, or a CSV file by `writetable`; MATLAB files are read by programs built with `--features matlab`".to_owned(),
            Self::NotLog { .. } => "give a log of ROS 2 (`ros2 bag record -s mcap`), or a CSV file; logs are read by programs built with `--features mcap`".to_owned(),
            Self::NotMdf { .. } => "copy the file again, or write a CSV file from it (`MDF(\"log.mf4\").export(\"csv\")` of asammdf); MDF 4 is read by programs built with `--features mdf`".to_owned(),
            Self::NotParquet { .. } => "copy the file again, or write a CSV file from it (`frame.to_csv`); Parquet is read by programs built with `--features parquet`".to_owned(),
            Self::HeaderWidth { .. } => "give every column its name in the header, and none to spare".to_owned(),
            Self::Ragged { .. } => {
                "give every row one cell a column; a decimal comma would split a number in two where commas separate columns".to_owned()
            }
            Self::UnknownColumn { meant: Some(meant), .. } => format!("did you mean `{meant}`?"),
            Self::UnknownColumn { .. } => "give one of these names, its unit may be left out, or the column's number".to_owned(),
            Self::DuplicateColumn { .. } => "give the column's number instead of its name, or rename one of them".to_owned(),
            Self::SameColumn { .. } => "give two columns".to_owned(),
            Self::NotMeasured { .. } => {
                "this is an input to be played: write the output measured at each sample into a column beside it".to_owned()
            }
            Self::LookAlike { meant, .. } => {
                format!("write `{meant}` if that is meant, else give the column another name")
            }
            Self::OtherDecimal { .. } => "write all numbers of the file with the same decimal sign".to_owned(),
            Self::OtherUnit { .. } => {
                "write all numbers of a column in one unit, best in its header alone".to_owned()
            }
            Self::CommasTwice { .. } => {
                "save the file with semicolons or tabs between columns, or with decimal points".to_owned()
            }
            Self::NotANumber { .. } | Self::NotFinite { .. } | Self::NotAStamp { .. } => {
                "write a finite number, or leave the cell empty where nothing was measured".to_owned()
            }
            Self::UnitsDiffer { .. } => "write both files in the same units".to_owned(),
            Self::NeverMoves { column } => format!("fit to records in which `{column}` rises and falls; check that the column holds the input"),
            Self::NothingMoves { .. } => "give a record of a machine that is driven; check that it was switched on, and the logger connected".to_owned(),
            Self::NeverChanges { column } => {
                format!("check the sensor, and that `{column}` is the column of the output")
            }
            Self::Doubtful { remedy, .. }
            | Self::NoSampleTime { remedy, .. }
            | Self::EmptyCell { remedy, .. }
            | Self::Interrupted { remedy }
            | Self::More { remedy, .. }
            | Self::NotATime { remedy, .. }
            | Self::OtherSampleTime { remedy, .. }
            | Self::SampleTimesDiffer { remedy, .. }
            | Self::CutTooShort { remedy, .. }
            | Self::Shattered { remedy, .. } => remedy.clone(),
            Self::NotIncreasing(step) | Self::Gap(step) | Self::Uneven(step) | Self::UnitChanges(step) | Self::StartsAnew(step) => step.remedy.clone(),
            Self::TooShort { .. } => {
                "take a longer record; the fit needs more samples than there are coefficients".to_owned()
            }
        }
    }
}

/// A text as far as it is read, its beginning and its end: names, cells and lists of columns in it are as long as a file has them.
fn shortened(text: String) -> String {
    /// Letters of the names of some hundred columns, and of the end, where sentences say what is wrong.
    const FIRST: usize = 5000;
    const LAST: usize = 1000;
    let between = text.chars().count().saturating_sub(FIRST + LAST);
    if between == 0 {
        return text;
    }
    let of = |letters: &mut dyn Iterator<Item = char>| letters.collect::<String>();
    let mut letters = text.chars();
    let first = of(&mut letters.by_ref().take(FIRST));
    format!("{first}… ({between} letters left out) …{}", of(&mut letters.skip(between)))
}

impl Display for DataError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let problem = shortened(self.problem.to_string());
        match self.place {
            Some(Place::Line(line)) => write!(f, "{}:{line}: {problem}", self.path),
            Some(Place::Row(row)) => write!(f, "{}, row {row}: {problem}", self.path),
            None => write!(f, "{}: {problem}", self.path),
        }
    }
}

impl Diagnostic for DataError {
    fn help<'a>(&'a self) -> Option<Box<dyn Display + 'a>> {
        Some(Box::new(shortened(self.problem.remedy())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_is_as_long_as_it_is_read() {
        let of = |reason: String| {
            let problem = DataProblem::NotLog { reason };
            DataError { path: "a.mcap".to_owned(), place: None, problem }.to_string()
        };
        assert!(of("short".to_owned()).ends_with(": short"));
        let long = of("ü".repeat(1 << 20));
        assert!(long.chars().count() < 6100 && long.contains("letters left out"), "{}", long.len());
        let row = |letters: usize| format!("{} is not a number", "x".repeat(letters));
        assert!(of(row(70_000)).ends_with("x is not a number") && of(row(5800)).contains(&row(5800)));
    }
}
