//! Where a table begins and what its columns are called.

use super::dialect::Dialect;
use super::error::{DataProblem, Place};
use super::lines::{Delimiter, is_comment, is_idle, numbered};
use super::unit;

/// What stands above the rows.
#[derive(Debug, Default)]
pub(super) struct Head {
    /// Name and unit of each column, empty where the file has no header.
    pub(super) names: Vec<(String, Option<String>)>,
    /// Line of the first row.
    pub(super) first_row: u64,
    /// Lines above the header that say nothing of the columns.
    pub(super) skipped: u64,
    pub(super) has_unit_row: bool,
    /// Line of the names.
    pub(super) line: u64,
}

/// The lines above the first row, nearest last; the ones in between that are blank are left out.
struct Above<'t> {
    lines: Vec<(u64, &'t str)>,
    first_row: u64,
}

impl Head {
    /// # Errors
    /// A header that has another width than the rows.
    pub(super) fn find(text: &str, dialect: &Dialect) -> Result<Self, (Place, DataProblem)> {
        let Above { lines, first_row } = above(text, dialect);
        // A comment names the columns only where no other line does.
        let plain: Vec<_> = lines.iter().copied().filter(|(_, line)| !is_comment(line)).collect();
        let is_named = plain.last().is_some_and(|(_, line)| header_cells(line, dialect).is_some());
        let lines = if is_named { plain } else { lines };
        let mut head = Self { first_row, ..Self::default() };
        let Some(((line, nearest), further)) = lines.split_last() else { return Ok(head) };
        let Some(cells) = header_cells(nearest, dialect) else {
            return match misfit(nearest, dialect) {
                Some(found) => {
                    let expected = dialect.width;
                    let is_twice = dialect.delimiter == Delimiter::Sign(',') && expected == 2 * found;
                    let problem = if is_twice {
                        DataProblem::CommasTwice { found, expected }
                    } else {
                        DataProblem::HeaderWidth { found, expected }
                    };
                    Err((Place::Line(*line), problem))
                }
                None => Ok(Self { skipped: *line, ..head }),
            };
        };
        let names_above = further.last().and_then(|(line, text)| Some((line, header_cells(text, dialect)?)));
        let is_unit_row = cells.iter().all(|cell| unit::is_unit(cell));
        match names_above {
            Some((names_line, names)) if is_unit_row && names.iter().any(|name| !unit::is_unit(name)) => {
                let named = names.iter().zip(&cells).map(|(name, cell)| {
                    let (name, own) = unit::split(name);
                    (name, unit::bare(cell).or(own))
                });
                head.names = named.collect();
                head.has_unit_row = true;
                head.line = *names_line;
            }
            _ => {
                head.names = cells.iter().map(|cell| unit::split(cell)).collect();
                head.line = *line;
            }
        }
        head.skipped = head.line - 1;
        Ok(head)
    }
}

/// Goes down to the first row, then up again over lines that are rows with a fault, which the rows' reader will show.
fn above<'t>(text: &'t str, dialect: &Dialect) -> Above<'t> {
    let mut cells = Vec::new();
    let mut lines: Vec<(u64, &str)> = Vec::new();
    let mut first_row = None;
    for (number, line) in numbered(text) {
        if line.trim().is_empty() {
            continue;
        }
        dialect.delimiter.split(line, &mut cells);
        if !is_idle(line) && dialect.is_row(&cells) {
            first_row = Some(number);
            break;
        }
        lines.push((number, line));
    }
    let mut first_row = first_row.unwrap_or(u64::MAX);
    while let Some(&(number, line)) = lines.last() {
        dialect.delimiter.split(line, &mut cells);
        let is_faulty_row = !is_idle(line) && cells.len() == dialect.width && !dialect.is_wordy(&cells);
        if !is_faulty_row || cells.iter().all(|cell| unit::is_unit(cell)) {
            break;
        }
        first_row = number;
        lines.pop();
    }
    Above { lines, first_row }
}

/// A line's cells if they can name the columns: as many as there are, in the rows' own delimiter or another.
fn header_cells<'t>(line: &'t str, dialect: &Dialect) -> Option<Vec<&'t str>> {
    let line =
        if is_comment(line) { line.trim_start().trim_start_matches(['#', '%', '/', ' ']) } else { line };
    let others = [',', ';', '\t', '|'].map(Delimiter::Sign);
    for delimiter in std::iter::once(dialect.delimiter).chain(others) {
        let mut cells = Vec::new();
        delimiter.split(line, &mut cells);
        while cells.len() > dialect.width && cells.last() == Some(&"") {
            cells.pop();
        }
        // Rows that end in a delimiter have a nameless last cell; that nothing stands in it is seen once they are read.
        if cells.len() + 1 == dialect.width && delimiter == dialect.delimiter && cells.len() >= 2 {
            cells.push("");
        }
        if cells.len() == dialect.width {
            return Some(cells);
        }
    }
    // Names that hold single blanks, in columns set apart by more of them.
    let columns: Vec<&str> = line.split("  ").map(str::trim).filter(|cell| !cell.is_empty()).collect();
    (columns.len() == dialect.width).then_some(columns)
}

/// The width of a line that looks like a header but does not fit. Blanks separate the words of any sentence, so they prove nothing.
fn misfit(line: &str, dialect: &Dialect) -> Option<usize> {
    let mut cells = Vec::new();
    dialect.delimiter.split(line, &mut cells);
    let looks_so = dialect.delimiter != Delimiter::Blanks && !is_comment(line) && dialect.is_wordy(&cells);
    (looks_so && cells.len() > 2).then_some(cells.len())
}
