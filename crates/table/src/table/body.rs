//! The rows of a table.

use super::cell::{self, Cell, Decimal};
use super::column::{Column, Fault, Kind};
use super::dates::Format;
use super::dialect::Dialect;
use super::error::{DataError, DataProblem, Place};
use super::head::Head;
use super::lines::is_idle;
use super::measurements::Table;
use super::unit;

/// Faults kept of a column or of the rows; of others only the count is reported.
pub(super) const KEPT: usize = 3;

/// Words that are kept of a column of text: signs and states are few, remarks many.
const WORDS: usize = 8;

impl Column {
    /// Adds a cell of a column of text.
    fn add_word(&mut self, row: usize, text: &str) {
        self.codes.resize(row, 0);
        let known = self.words.iter().position(|word| word == text);
        let place = known.or_else(|| {
            (!text.is_empty() && self.words.len() < WORDS).then(|| {
                self.words.push(text.to_owned());
                self.words.len() - 1
            })
        });
        self.codes.push(place.map_or(0, |place| place as u8 + 1));
    }

    /// Takes what looked like numbers with units for names: another cell is one.
    fn become_text(&mut self) {
        self.kind = Kind::Text;
        self.has_units = false;
        self.unit = None;
        self.values.fill(f64::NAN);
    }

    /// Adds a cell that is neither a value nor missing.
    pub(super) fn add_fault(&mut self, fault: Fault) {
        self.fault_count += 1;
        if self.faults.len() < KEPT {
            self.faults.push(fault);
        }
    }
}

/// Lines with fewer cells than columns.
#[derive(Default)]
struct Short {
    /// The first few.
    first: Vec<(u64, usize)>,
    last: Option<(u64, usize)>,
    count: usize,
}

/// Short lines that are enough to call them usual.
const USUAL: usize = 3;

/// Rows before they enter the columns of a table.
pub(super) struct Rows<'t> {
    table: &'t mut Table,
    dialect: Dialect,
    first_row: u64,
    /// The lines of the header, which may come again.
    header: Vec<String>,
    /// What stands before the values of a row, where each has its name.
    labels: Vec<String>,
    readers: Vec<Reader>,
    /// Lines with more cells than columns: the first few and the last, each with its cells.
    ragged: Vec<(u64, usize)>,
    /// Lines with fewer cells.
    short: Short,
    /// Lines of the header that came again.
    repeated: Vec<u64>,
    /// The last line that is no comment.
    last: u64,
}

impl<'t> Rows<'t> {
    /// The rows below a header.
    pub(super) fn of(table: &'t mut Table, dialect: Dialect, head: &Head) -> Self {
        let readers = table.columns.iter().map(|_| Reader::default()).collect();
        let (first_row, header, labels) = (head.first_row, head.lines.clone(), head.labels.clone());
        let (ragged, short, repeated) = (Vec::new(), Short::default(), Vec::new());
        Self { table, dialect, first_row, header, labels, readers, ragged, short, repeated, last: 0 }
    }

    /// Takes the next line of the text, whatever it holds.
    pub(super) fn push(&mut self, line: u64, text: &str) {
        if line < self.first_row || is_idle(text) {
            return;
        }
        if self.header.iter().any(|header| header == text.trim_end()) {
            self.repeat(line);
            return;
        }
        let mut cells = Vec::with_capacity(self.dialect.width);
        let Dialect { delimiter, form, .. } = self.dialect;
        if form.is_plain() {
            delimiter.split(text, &mut cells);
        } else if form.is_named() {
            self.split_by_name(text, &mut cells);
        } else {
            form.split(text, delimiter, &mut cells);
        }
        self.last = line;
        while cells.len() > self.dialect.width && cells.last() == Some(&"") {
            cells.pop();
        }
        let found = cells.len();
        if found > self.dialect.width || found < 2 && self.dialect.width > 1 {
            self.ragged.truncate(KEPT);
            self.ragged.push((line, found));
            return;
        }
        if found < self.dialect.width {
            self.short.count += 1;
            self.short.last = Some((line, found));
            if self.short.first.len() < KEPT {
                self.short.first.push((line, found));
            }
            cells.resize(self.dialect.width, "");
        }
        let row = self.table.places.len();
        for ((column, reader), text) in self.table.columns.iter_mut().zip(&mut self.readers).zip(&cells) {
            reader.push(column, row, text, self.dialect.decimal);
        }
        self.table.places.push(Place::Line(line));
    }

    /// The values of a line in the order of the columns whose names stand before them; one of another name is to spare.
    fn split_by_name<'l>(&self, text: &'l str, cells: &mut Vec<&'l str>) {
        cells.resize(self.dialect.width, "");
        let mut found = 0;
        for (k, (name, value)) in
            self.dialect.form.pairs(text, self.dialect.delimiter).into_iter().enumerate()
        {
            let is_own = |column: &usize| self.labels.get(*column).is_some_and(|label| label == name);
            let usual = Some(k).filter(is_own);
            match usual.or_else(|| (0..self.dialect.width).find(is_own)) {
                Some(column) => {
                    cells[column] = value;
                    found += 1;
                }
                None => cells.push(value),
            }
        }
        if found == 0 {
            cells.truncate(1);
        }
    }

    /// The header again: of several lines the first counts.
    fn repeat(&mut self, line: u64) {
        let row = self.table.places.len();
        if row > 0 && self.table.breaks.last() != Some(&row) {
            self.table.breaks.push(row);
            self.repeated.push(line);
        }
    }

    /// Rows so far.
    pub(super) fn len(&self) -> usize {
        self.table.places.len()
    }

    /// The rows so far as a table of their own; the next ones begin another.
    pub(super) fn take(&mut self) -> Table {
        self.table.take_rows()
    }

    /// Shows what was odd, once all lines are in.
    pub(super) fn finish(self) {
        let Self { table, dialect, readers, mut ragged, short, repeated, last, .. } = self;
        let rows = table.places.len();
        for (column, reader) in table.columns.iter().zip(&readers) {
            let Some(Place::Line(line)) =
                reader.midnights.first().filter(|row| **row < rows).map(|row| table.places.get(*row))
            else {
                continue;
            };
            let name = &column.name;
            table
                .notes
                .push(format!("the clock of `{name}` passes midnight at line {line} and is continued"));
        }
        if let Some(first) = repeated.first() {
            let note = match repeated.len() {
                1 => format!("the header again at line {first}"),
                count => format!("the header again at {count} lines, the first of them {first}"),
            };
            table.notes.push(note);
        }
        let is_last = |found: &Option<(u64, usize)>| found.is_some_and(|(line, _)| line == last);
        // A logger that was switched off leaves its last line unfinished. Where lines are often short, empty cells were left out.
        let others = short.count - usize::from(is_last(&short.last));
        let is_usual = others >= USUAL || 100 * others > rows;
        let cut_off = match is_usual {
            true => None,
            false => short
                .last
                .filter(|_| is_last(&short.last))
                .or_else(|| ragged.pop_if(|(line, found)| *line == last && *found < dialect.width)),
        };
        if let Some((line, found)) = cut_off {
            table.notes.push(format!("line {line}, the last, is cut off and left out"));
            if found >= 2 || dialect.width == 1 {
                table.drop_last_row();
            }
        }
        if is_usual && let Some((line, found)) = short.first.first() {
            table.notes.push(format!(
                "{} lines have fewer than {} cells, the first of them line {line} with {found}: the others are taken as empty",
                short.count, dialect.width
            ));
        }
        let fault = |&(line, found): &(u64, usize)| DataError {
            path: table.path.clone(),
            place: Some(Place::Line(line)),
            problem: DataProblem::Ragged { found, expected: dialect.width },
        };
        let odd = short.first.iter().filter(|short| !is_usual && Some(**short) != cut_off).chain(&ragged);
        let mut odd: Vec<&(u64, usize)> = odd.collect();
        odd.sort();
        let faults = odd.into_iter().take(KEPT).map(fault).collect();
        table.cut_off = cut_off.as_ref().map(fault);
        table.faults = faults;
    }
}

/// What the cells so far make of a column.
#[derive(Default)]
pub(super) struct Reader {
    is_decided: bool,
    /// Whether numbers have more digits than a value keeps.
    is_long: bool,
    /// Whether a number stood without a unit, other than 0.
    is_plain: bool,
    /// Whether numbers with units may be names.
    is_name: bool,
    /// How times are written.
    format: Option<Format>,
    /// Whether stamps are times of day.
    is_clock: bool,
    first_stamp: i128,
    last_stamp: i128,
    /// Rows at which a clock passes midnight.
    midnights: Vec<usize>,
}

/// Whether a whole number has more digits than a value keeps.
fn is_long(text: &str) -> bool {
    const MOST: i128 = 1 << f64::MANTISSA_DIGITS;
    text.parse().is_ok_and(|number: i128| number.abs() > MOST)
}

/// Nanoseconds of a day.
const DAY: i128 = 86_400_000_000_000;

impl Reader {
    /// Takes the next cell of a column.
    pub(super) fn push(&mut self, column: &mut Column, row: usize, text: &str, decimal: Decimal) {
        let cell = cell::read_in(text, decimal, &mut self.format);
        if !self.is_decided && cell != Cell::Missing {
            self.is_decided = true;
            column.kind = self.kind(cell, text, decimal);
            column.origin = if column.kind == Kind::Stamp { self.first_stamp } else { 0 };
            self.is_long = column.kind == Kind::Number && is_long(text);
        }
        if cell == Cell::Text && column.has_units && self.is_name {
            column.become_text();
        }
        let value = match (column.kind, cell) {
            (Kind::Stamp, Cell::Stamp(now)) if !self.is_clock => Some(self.since_first(now)),
            (Kind::Stamp, Cell::Clock(now)) if self.is_clock => Some(self.continued(row, now)),
            (Kind::Number | Kind::Text, Cell::Number(value)) if value.is_finite() => {
                self.is_plain |= value != 0.0;
                // Zero is zero in all units.
                (!column.has_units || value == 0.0).then_some(value)
            }
            (Kind::Number, Cell::Quantity(value)) => self.in_unit(column, (text, decimal), value),
            (_, Cell::Missing) => Some(f64::NAN),
            _ => None,
        };
        column.values.push(value.unwrap_or(f64::NAN));
        if column.kind == Kind::Stamp || self.is_long {
            column.stamps.resize(row, String::new());
            column.stamps.push(text.to_owned());
        }
        if column.kind == Kind::Text {
            column.add_word(row, text);
        }
        if value.is_none() {
            column.add_fault(Fault { row, cell: text.to_owned() });
        }
    }

    /// A number with its unit: the column takes the first, and no other is the same quantity.
    #[inline(never)]
    fn in_unit(&mut self, column: &mut Column, (text, decimal): (&str, Decimal), value: f64) -> Option<f64> {
        let (_, unit) = cell::quantity(text, decimal)?;
        if self.is_plain {
            return None;
        }
        self.is_name |= cell::is_name(text);
        column.has_units = true;
        let own = column.unit.get_or_insert_with(|| unit::bare(unit).unwrap_or_else(|| unit.to_owned()));
        unit::is_same(own, unit).then_some(value)
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
