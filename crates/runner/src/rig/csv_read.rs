//! One record's CSV file.

use super::csv_error::{CsvError, CsvProblem};
use super::sampling;
use csv::{ReaderBuilder, StringRecord, Trim};
use std::path::Path;

/// The columns of a record, all of the same length.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Columns {
    pub(super) v: Vec<f64>,
    pub(super) y: Vec<f64>,
    pub(super) y_sim: Option<Vec<f64>>,
}

/// What a record must satisfy.
#[derive(Debug, Clone, Copy)]
pub(super) struct Demands {
    pub(super) sample_time: f64,
    pub(super) samples: usize,
}

const NAMES: [&str; 4] = ["t", "v", "y", "y_sim"];

/// Reads the columns `t`, `v`, `y` and, if there, `y_sim` by their names; other columns are ignored.
pub(super) fn parse(path: &Path, text: &str, demands: Demands) -> Result<Columns, CsvError> {
    let fail = |line: Option<u64>, problem| CsvError { path: path.display().to_string(), line, problem };
    if text.trim().is_empty() {
        return Err(fail(None, CsvProblem::Empty));
    }
    // Flexible, so that a ragged row is told in our words.
    let mut reader =
        ReaderBuilder::new().has_headers(false).flexible(true).trim(Trim::All).from_reader(text.as_bytes());
    let mut rows = reader.records().map(|row| {
        row.map(|row| (line_of(text, &row), row)).map_err(|error| {
            fail(error.position().map(|p| p.line()), CsvProblem::Unparsable { message: error.to_string() })
        })
    });
    let (header_line, header) = rows.next().transpose()?.ok_or_else(|| fail(None, CsvProblem::Empty))?;
    let positions = columns(&header).map_err(|problem| fail(Some(header_line), problem))?;

    let mut values: [Vec<f64>; 4] = Default::default();
    let mut lines = Vec::new();
    for row in rows {
        let (line, row) = row?;
        if row.len() != header.len() {
            return Err(fail(Some(line), CsvProblem::Ragged { found: row.len(), expected: header.len() }));
        }
        for ((name, position), column) in NAMES.into_iter().zip(positions).zip(&mut values) {
            if let Some(position) = position {
                column.push(number(name, &row[position]).map_err(|problem| fail(Some(line), problem))?);
            }
        }
        lines.push(line);
    }

    let [t, v, y, y_sim] = values;
    sampling::check(&t, demands.sample_time)
        .map_err(|(index, problem)| fail(index.map(|index| lines[index]), problem))?;
    if t.len() < demands.samples {
        return Err(fail(None, CsvProblem::TooShort { found: t.len(), needed: demands.samples }));
    }
    Ok(Columns { v, y, y_sim: positions[3].map(|_| y_sim) })
}

/// Where each of [`NAMES`] stands in the header; all but `y_sim` must.
fn columns(header: &StringRecord) -> Result<[Option<usize>; 4], CsvProblem> {
    let mut positions = [None; 4];
    for (column, name) in NAMES.into_iter().enumerate() {
        let mut found = (0..header.len()).filter(|&i| &header[i] == name);
        positions[column] = found.next();
        if found.next().is_some() {
            return Err(CsvProblem::DuplicateColumn { column: name });
        }
    }
    if header.iter().eq(["t", "v"]) {
        return Err(CsvProblem::NotMeasured);
    }
    if let Some(missing) = (0..3).find(|&column| positions[column].is_none()) {
        let header = header.iter().collect::<Vec<_>>().join(",");
        return Err(CsvProblem::MissingColumn { column: NAMES[missing], header });
    }
    // Ignoring a misspelt `y_sim` would silently diagnose another model than the user's.
    let letters = |name: &str| name.to_lowercase().replace(['_', '-', ' '], "");
    if let Some(found) = header.iter().find(|name| *name != "y_sim" && letters(name) == "ysim") {
        return Err(CsvProblem::LookAlike { found: found.to_owned(), meant: "y_sim" });
    }
    Ok(positions)
}

fn number(column: &'static str, cell: &str) -> Result<f64, CsvProblem> {
    match cell.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(CsvProblem::NotFinite { column, cell: cell.to_owned() }),
        Err(_) if cell.is_empty() => Err(CsvProblem::EmptyCell { column }),
        Err(_) => Err(CsvProblem::NotANumber { column, cell: cell.to_owned() }),
    }
}

/// The line that a row stands on. The reader counts from where the row before it ended, so blank lines are added.
fn line_of(text: &str, row: &StringRecord) -> u64 {
    let Some(position) = row.position() else { return 1 };
    let rest = text.as_bytes().get(position.byte() as usize..).unwrap_or_default();
    let blank =
        rest.iter().take_while(|byte| matches!(byte, b'\r' | b'\n')).filter(|byte| **byte == b'\n').count();
    position.line() + blank as u64
}
