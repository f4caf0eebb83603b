//! A file of measurements as named columns of numbers, whatever its dialect.
//!
//! Recognised without being reported: what separates cells, decimal commas, the header and a row of units, what stands above the table,
//! comments (`#`, `%`, `//`), names and units beside values, missing values, ISO 8601 time stamps, the encoding. What was recognised is kept in [`Table::notes`], to be reported.

mod body;
mod cell;
mod column;
mod dates;
mod dialect;
mod error;
mod form;
mod head;
mod keyed;
mod lines;
mod measurements;
mod memory;
mod places;
mod preamble;
mod silent;
mod table_error;
#[cfg(test)]
mod tests;
pub mod unit;
mod unit_lists;
mod unit_words;

pub use column::Column;
pub use column::Kind;
pub(crate) use column::empty_column;
pub use error::DataError;
pub use error::DataProblem;
pub use error::Place;
pub use error::Step;
pub use measurements::Table;
pub use memory::Cells;
pub use places::Places;
pub use table_error::TableError;

use crate::chosen::LogReader;
use crate::door::{LARGEST, read_within};
use crate::text_pieces::{PieceError, TextPieces};
use crate::{encodings, log, mat, mdf, parquet_file};
use body::Rows;
use dialect::Dialect;
use head::Head;
use lines::Delimiter;
use std::path::Path;

/// Why a text gives no table.
enum Unread {
    Reported(TableError),
    /// It is not UTF-8, as was guessed.
    NotUtf8,
}

impl Unread {
    /// In an older encoding every text is one.
    fn reported(self) -> TableError {
        match self {
            Self::Reported(error) => error,
            Self::NotUtf8 => unreachable!("every byte is a letter"),
        }
    }
}

impl From<DataError> for Unread {
    fn from(error: DataError) -> Self {
        Self::Reported(TableError::Data(error))
    }
}

impl From<PieceError> for Unread {
    fn from(error: PieceError) -> Self {
        match error {
            PieceError::File(error) => Self::Reported(TableError::File(error)),
            PieceError::NotUtf8 => Self::NotUtf8,
        }
    }
}

/// Bytes of text looked at for its dialect at first: more than most preambles and headers take.
const ENOUGH: usize = 1 << 18;

impl Table {
    /// Reads a file of measurements of so many columns at least, one or two: text, or with the feature `matlab` a `.mat` file.
    ///
    /// # Errors
    /// A file that cannot be read, or holds no table. Single rows and cells that are wrong are kept in the table.
    pub fn read(path: &Path, least: usize) -> Result<Self, TableError> {
        let pieces = TextPieces::open(path).map_err(TableError::File)?;
        if mat::is_matlab(path, pieces.first_bytes()) {
            return mat::read(path, read_within(path, LARGEST).map_err(TableError::File)?);
        }
        if parquet_file::is_parquet(path, pieces.first_bytes()) {
            return parquet_file::read(path);
        }
        match Self::of_pieces(path, pieces, least) {
            Err(Unread::NotUtf8) => {
                let again = TextPieces::open(path)
                    .and_then(TextPieces::in_older_encoding)
                    .map_err(TableError::File)?;
                Self::of_pieces(path, again, least).map_err(Unread::reported)
            }
            table => table.map_err(Unread::reported),
        }
    }

    /// What reads a file that is a log of signals, each with a clock of its own, rather than a table.
    ///
    /// # Errors
    /// A file that cannot be opened.
    pub(crate) fn log_reader(path: &Path) -> Result<Option<LogReader>, TableError> {
        let pieces = TextPieces::open(path).map_err(TableError::File)?;
        let is = |kind: fn(&Path, &[u8]) -> bool| kind(path, pieces.first_bytes());
        Ok(match () {
            () if is(log::is_log) => Some(log::read),
            () if is(mdf::is_mdf) => Some(mdf::read),
            () => None,
        })
    }

    /// The table in a text.
    pub fn parse(text: &str, least: usize) -> Result<Self, TableError> {
        let path = Path::new("");
        Self::of_pieces(path, TextPieces::of_text("", text), least).map_err(Unread::reported)
    }

    /// Reads a file of text in tables of so many rows at most, one after the other, until `take` wants no more; says whether that was possible.
    ///
    /// # Errors
    /// As of [`read`](Self::read).
    pub fn batches(
        path: &Path,
        (least, most): (usize, usize),
        take: &mut dyn FnMut(Self) -> bool,
    ) -> Result<bool, TableError> {
        let pieces = TextPieces::open(path).map_err(TableError::File)?;
        let is = |kind: fn(&Path, &[u8]) -> bool| kind(path, pieces.first_bytes());
        if is(mat::is_matlab) || is(log::is_log) || is(mdf::is_mdf) || is(parquet_file::is_parquet) {
            return Ok(false);
        }
        match Self::in_batches(path, pieces, (least, most), take) {
            Ok(()) => Ok(true),
            Err(Unread::NotUtf8) => Ok(false),
            Err(error) => Err(error.reported()),
        }
    }

    fn of_pieces(path: &Path, pieces: TextPieces<'_>, least: usize) -> Result<Self, Unread> {
        let mut whole = Self::default();
        Self::in_batches(path, pieces, (least, usize::MAX), &mut |table| {
            whole = table;
            true
        })?;
        Ok(whole)
    }

    /// The first lines show the dialect; then rows are read line by line, and no more of the text is held than a piece.
    fn in_batches(
        path: &Path,
        mut pieces: TextPieces<'_>,
        (least, most): (usize, usize),
        take: &mut dyn FnMut(Self) -> bool,
    ) -> Result<(), Unread> {
        let path = path.display().to_string();
        let fail = |place, problem| DataError { path: path.clone(), place, problem };
        let mut text = beginning(&mut pieces)?;
        if text.trim().is_empty() {
            return Err(fail(None, DataProblem::Empty).into());
        }
        let end = lines::end(&text);
        let whole = if pieces.has_ended() { text.len() } else { text.rfind(end).unwrap_or(text.len()) };
        let first = &text[..whole];
        let single = || if least <= 1 { Dialect::single(first) } else { None };
        let dialect = Dialect::of(first).or_else(single);
        let mut dialect = dialect.ok_or_else(|| fail(None, no_table(first)))?;
        let head = Head::find(first, &mut dialect).map_err(|(place, problem)| fail(Some(place), problem))?;
        let mut table = Self {
            path: path.clone(),
            columns: columns(&head, dialect.width),
            has_header: !head.names.is_empty(),
            notes: notes(&head, &dialect),
            increment: head.increment,
            ..Self::default()
        };
        table.notes.splice(..0, encoding(&pieces, &table.columns));
        let without_blank = |table: Self| {
            let problem = DataProblem::HeaderWidth { found: dialect.width - 1, expected: dialect.width };
            table.without_blank_end().ok_or_else(|| fail(Some(Place::Line(head.line)), problem))
        };
        let mut rows = Rows::of(&mut table, dialect, &head);
        let mut line = 0;
        loop {
            let mut rest = text.as_str();
            while let Some((whole, after)) = rest.split_once(end) {
                line += 1;
                rows.push(line, lines::without_return(whole));
                rest = after;
                if rows.len() >= most && !take(without_blank(rows.take())?) {
                    return Ok(());
                }
            }
            if pieces.has_ended() {
                rows.push(line + 1, lines::without_return(rest));
                break;
            }
            let taken = text.len() - rest.len();
            text.drain(..taken);
            pieces.append_to(&mut text)?;
        }
        rows.finish();
        take(without_blank(table)?);
        Ok(())
    }

    /// Leaves out columns without name and cells: a delimiter at the end of every row makes none. None where a nameless last one has values.
    fn without_blank_end(mut self) -> Option<Self> {
        let has_none = |column: &Column| column.values.iter().all(|x| x.is_nan());
        if self.columns.last().is_some_and(|last| last.name.is_empty() && !has_none(last)) {
            return None;
        }
        let is_text = |column: &Column| column.kind == Kind::Text || column.fault_count > 0;
        self.columns.retain(|column| !column.name.is_empty() || !has_none(column) || is_text(column));
        Some(self)
    }
}

/// In which encoding a text was read, where it is not UTF-8, and a name that makes one doubt it.
fn encoding(pieces: &TextPieces<'_>, columns: &[Column]) -> Option<String> {
    let encoding = pieces.encoding()?;
    let unlikely = columns.iter().find(|column| encodings::is_unlikely(&column.name));
    let doubted = unlikely.filter(|_| pieces.is_in_windows_1252());
    Some(match doubted {
        Some(Column { name, .. }) => {
            format!(
                "text in {encoding}, though `{name}` is no likely name: save the file as UTF-8 if it is another"
            )
        }
        None => format!("text in {encoding}"),
    })
}

/// Shows the first line that has a digit, else the first at all.
fn no_table(text: &str) -> DataProblem {
    /// Letters that are shown of it.
    const SHOWN: usize = 60;
    let lines = || lines::numbered(text).filter(|(_, line)| !line.trim().is_empty());
    let measured =
        lines().find(|(_, line)| !lines::is_comment(line) && line.contains(|c: char| c.is_ascii_digit()));
    let (line, text) = measured.or_else(|| lines().next()).unwrap_or((1, ""));
    let text = text.trim();
    let visible = |c: char| if c.is_control() { ' ' } else { c };
    let mut shown: String = text.chars().take(SHOWN).map(visible).collect();
    if shown.len() < text.len() {
        shown.push('…');
    }
    DataProblem::NoTable { line, shown }
}

/// As much of a text as shows its dialect.
fn beginning(pieces: &mut TextPieces<'_>) -> Result<String, Unread> {
    let mut text = String::new();
    let mut wanted = ENOUGH;
    while !pieces.has_ended() && !Dialect::is_seen_in(&text) {
        while !pieces.has_ended() && text.len() < wanted {
            pieces.append_to(&mut text)?;
        }
        wanted *= 2;
    }
    Ok(text)
}

fn columns(head: &Head, width: usize) -> Vec<Column> {
    let named = (0..width).map(|k| match head.names.get(k) {
        Some((name, unit)) => (name.clone(), unit.clone()),
        None => (format!("column {}", k + 1), None),
    });
    named.map(|(name, unit)| empty_column(name, unit)).collect()
}

fn notes(head: &Head, dialect: &Dialect) -> Vec<String> {
    let mut notes = Vec::new();
    match head.skipped {
        0 => {}
        1 => notes.push("line 1 above the table left out".to_owned()),
        lines => notes.push(format!("lines 1 to {lines} above the table left out")),
    }
    if dialect.delimiter != Delimiter::Sign(',') {
        notes.push(format!("{} between columns", dialect.delimiter.name()));
    }
    if dialect.decimal == cell::Decimal::Comma {
        notes.push("decimal commas".to_owned());
    }
    notes.extend(dialect.form.described().map(str::to_owned));
    if head.has_unit_row {
        notes.push("a row of units".to_owned());
    }
    if head.names.is_empty() {
        notes.push("no header".to_owned());
    }
    notes
}
