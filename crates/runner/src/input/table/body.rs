//! The rows of a table.

use super::cell::{self, Cell};
use super::dialect::Dialect;
use super::error::{DataError, DataProblem, Place};
use super::lines::{is_idle, numbered};
use super::{Column, Fault, Kind, Table};

/// Faults kept of a column or of the rows; of others only the count is told.
pub(super) const KEPT: usize = 3;

/// Reads the rows from line `first_row` on into the columns.
pub(super) fn fill(table: &mut Table, text: &str, dialect: &Dialect, first_row: u64) {
    let mut readers: Vec<Reader> = table.columns.iter().map(|_| Reader::default()).collect();
    let mut cells = Vec::new();
    let mut ragged = Vec::new();
    let skipped = usize::try_from(first_row - 1).unwrap_or(usize::MAX);
    let mut last = 0;
    for (line, text) in numbered(text).skip(skipped).filter(|(_, text)| !is_idle(text)) {
        dialect.delimiter.split(text, &mut cells);
        last = line;
        while cells.len() > dialect.width && cells.last() == Some(&"") {
            cells.pop();
        }
        if cells.len() != dialect.width {
            ragged.push((line, cells.len()));
            continue;
        }
        let row = table.places.len();
        for ((column, reader), text) in table.columns.iter_mut().zip(&mut readers).zip(&cells) {
            reader.push(column, row, text, cell::read(text, dialect.decimal));
        }
        table.places.push(Place::Line(line));
    }
    // A logger that was switched off leaves its last line unfinished.
    let cut_off = ragged.pop_if(|(line, found)| *line == last && *found < dialect.width);
    if cut_off.is_some() {
        table.notes.push(format!("line {last}, the last, is cut off and left out"));
    }
    let fault = |&(line, found): &(u64, usize)| DataError {
        path: table.path.clone(),
        place: Some(Place::Line(line)),
        problem: DataProblem::Ragged { found, expected: dialect.width },
    };
    table.cut_off = cut_off.as_ref().map(fault);
    table.faults = ragged.iter().take(KEPT).map(fault).collect();
}

/// What the first cell that says something makes of a column.
#[derive(Default)]
struct Reader {
    is_decided: bool,
    first_stamp: i128,
}

impl Reader {
    fn push(&mut self, column: &mut Column, row: usize, text: &str, cell: Cell) {
        if !self.is_decided && cell != Cell::Missing {
            self.is_decided = true;
            column.kind = match cell {
                Cell::Stamp(first) => {
                    self.first_stamp = first;
                    Kind::Stamp
                }
                Cell::Text => Kind::Text,
                _ => Kind::Number,
            };
        }
        let value = match (column.kind, cell) {
            (Kind::Stamp, Cell::Stamp(now)) => Some((now - self.first_stamp) as f64 / 1e9),
            (Kind::Number | Kind::Text, Cell::Number(value)) if value.is_finite() => Some(value),
            (_, Cell::Missing) => Some(f64::NAN),
            _ => None,
        };
        column.values.push(value.unwrap_or(f64::NAN));
        if value.is_none() {
            column.fault_count += 1;
            if column.faults.len() < KEPT {
                column.faults.push(Fault { row, cell: text.to_owned() });
            }
        }
    }
}
