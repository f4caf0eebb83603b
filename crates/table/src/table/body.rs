//! The rows of a table.

use super::cell::{self, Cell, Decimal};
use super::column::{Column, Fault, Kind};
use super::dialect::Dialect;
use super::error::{DataError, DataProblem, Place};
use super::lines::is_idle;
use super::measurements::Table;

/// Faults kept of a column or of the rows; of others only the count is reported.
pub(super) const KEPT: usize = 3;

impl Column {
    /// Adds a cell that is neither a value nor missing.
    pub(super) fn add_fault(&mut self, fault: Fault) {
        self.fault_count += 1;
        if self.faults.len() < KEPT {
            self.faults.push(fault);
        }
    }
}

/// Rows before they enter the columns of a table.
pub(super) struct Rows<'t> {
    table: &'t mut Table,
    dialect: Dialect,
    first_row: u64,
    readers: Vec<Reader>,
    /// Lines of another width: the first few and the last, each with its cells.
    ragged: Vec<(u64, usize)>,
    /// The last line that is no comment.
    last: u64,
}

impl<'t> Rows<'t> {
    /// Rows that begin at line `first_row`.
    pub(super) fn of(table: &'t mut Table, dialect: Dialect, first_row: u64) -> Self {
        let readers = table.columns.iter().map(|_| Reader::default()).collect();
        Self { table, dialect, first_row, readers, ragged: Vec::new(), last: 0 }
    }

    /// Takes the next line of the text, whatever it holds.
    pub(super) fn push(&mut self, line: u64, text: &str) {
        if line < self.first_row || is_idle(text) {
            return;
        }
        let mut cells = Vec::with_capacity(self.dialect.width);
        self.dialect.delimiter.split(text, &mut cells);
        self.last = line;
        while cells.len() > self.dialect.width && cells.last() == Some(&"") {
            cells.pop();
        }
        if cells.len() != self.dialect.width {
            self.ragged.truncate(KEPT);
            self.ragged.push((line, cells.len()));
            return;
        }
        let row = self.table.places.len();
        for ((column, reader), text) in self.table.columns.iter_mut().zip(&mut self.readers).zip(&cells) {
            reader.push(column, row, text, self.dialect.decimal);
        }
        self.table.places.push(Place::Line(line));
    }

    /// Shows what was odd, once all lines are in.
    pub(super) fn finish(self) {
        let Self { table, dialect, readers, mut ragged, last, .. } = self;
        for (column, reader) in table.columns.iter().zip(&readers) {
            let Some(Place::Line(line)) = reader.midnights.first().map(|row| table.places.get(*row)) else {
                continue;
            };
            let name = &column.name;
            table
                .notes
                .push(format!("the clock of `{name}` passes midnight at line {line} and is continued"));
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
}

/// What the cells so far make of a column.
#[derive(Default)]
pub(super) struct Reader {
    is_decided: bool,
    /// Whether stamps are times of day.
    is_clock: bool,
    first_stamp: i128,
    last_stamp: i128,
    /// Rows at which a clock passes midnight.
    midnights: Vec<usize>,
}

/// Nanoseconds of a day.
const DAY: i128 = 86_400_000_000_000;

impl Reader {
    /// Takes the next cell of a column.
    pub(super) fn push(&mut self, column: &mut Column, row: usize, text: &str, decimal: Decimal) {
        let cell = cell::read(text, decimal);
        if !self.is_decided && cell != Cell::Missing {
            self.is_decided = true;
            column.kind = self.kind(cell, text, decimal);
        }
        let value = match (column.kind, cell) {
            (Kind::Stamp, Cell::Stamp(now)) if !self.is_clock => Some(self.since_first(now)),
            (Kind::Stamp, Cell::Clock(now)) if self.is_clock => Some(self.continued(row, now)),
            (Kind::Number | Kind::Text, Cell::Number(value)) if value.is_finite() => Some(value),
            (_, Cell::Missing) => Some(f64::NAN),
            _ => None,
        };
        column.values.push(value.unwrap_or(f64::NAN));
        if column.kind == Kind::Stamp {
            column.stamps.resize(row, String::new());
            column.stamps.push(text.to_owned());
        }
        if value.is_none() {
            column.add_fault(Fault { row, cell: text.to_owned() });
        }
    }

    /// What the first cell that says something makes of a column. A number with the other decimal sign is meant as one.
    fn kind(&mut self, cell: Cell, text: &str, decimal: Decimal) -> Kind {
        match cell {
            Cell::Stamp(first) | Cell::Clock(first) => {
                (self.first_stamp, self.last_stamp) = (first, first);
                self.is_clock = matches!(cell, Cell::Clock(_));
                Kind::Stamp
            }
            Cell::Text if !matches!(cell::read(text, decimal.other()), Cell::Number(_)) => Kind::Text,
            _ => Kind::Number,
        }
    }

    fn since_first(&self, now: i128) -> f64 {
        (now - self.first_stamp) as f64 / 1e9
    }

    /// A clock without dates that jumps back by more than half a day has passed midnight.
    fn continued(&mut self, row: usize, now: i128) -> f64 {
        let days = self.midnights.len() as i128;
        let mut now = now + days * DAY;
        if now < self.last_stamp - DAY / 2 {
            self.midnights.push(row);
            now += DAY;
        }
        self.last_stamp = now;
        self.since_first(now)
    }
}
