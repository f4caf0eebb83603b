//! Where a table begins and what its columns are called.

use super::dialect::Dialect;
use super::error::{DataProblem, Place};
use super::keyed::{self, Named};
use super::lines::{self, Delimiter, is_comment, is_idle, numbered};
use super::{preamble, silent, unit, unit_lists};

/// What stands above the rows.
#[derive(Debug, Default)]
pub(super) struct Head {
    /// Name and unit of each column, empty where the file has no header.
    pub(super) names: Vec<Named>,
    /// Line of the first row.
    pub(super) first_row: u64,
    /// Lines above the header that say nothing of the columns.
    pub(super) skipped: u64,
    pub(super) has_unit_row: bool,
    /// Line of the names.
    pub(super) line: u64,
    /// The lines of names and units, as they stand in the file.
    pub(super) lines: Vec<String>,
    /// What stands before the values of a row, where each has its name.
    pub(super) labels: Vec<String>,
    /// Seconds between rows, where a line above them says so.
    pub(super) increment: Option<f64>,
    /// From the first row to the next, in the first column.
    step: Option<f64>,
}

/// The lines above the first row, nearest last; the ones in between that are blank are left out.
struct Above<'t> {
    lines: Vec<(u64, &'t str)>,
    first_row: u64,
}

/// A line that can name the columns.
struct Candidate<'t> {
    line: u64,
    text: &'t str,
    cells: Vec<&'t str>,
}

impl Candidate<'_> {
    /// Where cells have lines of their own, the number is that of the last.
    fn first_line(&self) -> u64 {
        self.line - self.text.matches('\n').count() as u64
    }
}

impl Head {
    /// Where the header has more cells than the rows, the dialect takes its width: cells at the end of rows may be left out.
    ///
    /// # Errors
    /// A header that has fewer cells than the rows.
    pub(super) fn find(text: &str, dialect: &mut Dialect) -> Result<Self, (Place, DataProblem)> {
        if dialect.form.is_named() {
            return Ok(Self::beside_values(text, dialect));
        }
        let Above { lines: all, first_row } = above(text, dialect);
        let increment = preamble::increment(&all);
        let step = step(text, first_row, dialect);
        let head = Self { first_row, increment, step, ..Self::default() };
        let mut head = Self::above_rows((text, &all), dialect, head)?;
        unit_lists::add_units(&mut head.names, &all);
        keyed::add_units(&mut head.names, &all, dialect);
        Ok(head)
    }

    /// The names that stand before the values of the first row.
    fn beside_values(text: &str, dialect: &Dialect) -> Self {
        let mut cells = Vec::new();
        let first = numbered(text).find(|(_, line)| {
            dialect.split(line, &mut cells);
            !is_idle(line) && dialect.is_row(&cells)
        });
        let (line, first) = first.unwrap_or((u64::MAX, ""));
        let pairs = dialect.form.pairs(first, dialect.delimiter);
        let labels: Vec<String> = pairs.into_iter().map(|(name, _)| name.to_owned()).collect();
        let names = labels.iter().map(|label| unit::split(label)).collect();
        Self { names, labels, first_row: line, line, skipped: line - 1, ..Self::default() }
    }

    fn above_rows(
        (text, all): (&str, &[(u64, &str)]),
        dialect: &mut Dialect,
        head: Self,
    ) -> Result<Self, (Place, DataProblem)> {
        // A comment names the columns only where no other line does.
        let plain: Vec<_> = all.iter().copied().filter(|(_, line)| !is_comment(line)).collect();
        let nearest = plain.iter().rev().map(|(_, line)| *line).find(|line| !silent::is(line, dialect));
        let is_named = nearest.is_some_and(|line| header_cells(line, dialect).is_some());
        if let Some(width) = nearest.filter(|_| !is_named).and_then(|line| misfit(line, dialect))
            && width > dialect.width
        {
            dialect.width = width;
            return Self::named(&plain, dialect, head);
        }
        let is_listed = !is_named || nearest.is_some_and(keyed::is_counted);
        if is_listed && let Some(names) = keyed::counted(all, dialect.width) {
            let line = all.last().map_or(0, |(line, _)| *line);
            return Ok(Self { names, skipped: line, line, ..head });
        }
        Self::named(if is_named { &plain } else { all }, dialect, head)
            .map(|head| if head.names.is_empty() { head.numbered(text, dialect) } else { head })
    }

    fn named(lines: &[(u64, &str)], dialect: &Dialect, head: Self) -> Result<Self, (Place, DataProblem)> {
        let Some((line, _)) = lines.last() else { return Ok(head) };
        if let Some(described) = keyed::described(lines, dialect, head.step) {
            return Ok(Self { names: described, skipped: *line, line: *line, ..head });
        }
        if let Some((line, names)) = keyed::named(lines, dialect) {
            return Ok(Self { names, has_unit_row: true, skipped: line - 1, line, ..head });
        }
        let candidates = candidates(lines, dialect);
        if candidates.is_empty() {
            let nearest = lines.iter().rev().find(|(_, line)| !silent::is(line, dialect));
            let misfit = nearest.and_then(|(line, nearest)| Some((line, misfit(nearest, dialect)?)));
            return match misfit {
                Some((line, found)) => {
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
        }
        Ok(Self::of_candidates(&candidates, head))
    }

    /// The line right above the units is the header; without units the one with the most distinct names, and of several the nearest.
    fn of_candidates(candidates: &[Candidate<'_>], head: Self) -> Self {
        let units = units(candidates);
        let rank = |(k, candidate): &(usize, &Candidate<'_>)| {
            let is_above = units.is_some_and(|units| units + 1 == *k);
            (units != Some(*k), is_above, distinct(&candidate.cells), std::cmp::Reverse(*k))
        };
        let best = candidates.iter().enumerate().max_by_key(rank).map_or(0, |(k, _)| k);
        let names = &candidates[best];
        let units = units.filter(|k| *k != best).map(|k| &candidates[k]);
        let cell_of = |k: usize| {
            let cell = units?.cells.get(k)?;
            // The first one may name the row.
            if k == 0 { unit::bare(cell) } else { unit::meant(cell) }
        };
        let named = names.cells.iter().enumerate().map(|(k, name)| {
            let (name, own) = unit::split(&plain(name));
            (name, cell_of(k).or(own))
        });
        let beside = candidates.iter().filter(|other| other.line != names.line);
        let increment = beside
            .flat_map(|other| names.cells.iter().zip(&other.cells))
            .find_map(|(name, value)| preamble::entry(name, value));
        let taken = [Some(names), units];
        Self {
            names: named.collect(),
            has_unit_row: units.is_some(),
            line: names.line,
            skipped: [candidates.last(), Some(names), units]
                .into_iter()
                .flatten()
                .map(Candidate::first_line)
                .min()
                .map_or(0, |first| first - 1),
            lines: taken.into_iter().flatten().map(|taken| taken.text.trim_end().to_owned()).collect(),
            increment: increment.or(head.increment),
            ..head
        }
    }

    /// Columns that a program without names for them has numbered: the first row counts, and the next does not.
    fn numbered(self, text: &str, dialect: &Dialect) -> Self {
        let mut rows = numbered(text).filter(|(line, text)| *line >= self.first_row && !is_idle(text));
        let (Some((line, first)), Some((_, second))) = (rows.next(), rows.next()) else { return self };
        let (mut names, mut values) = (Vec::new(), Vec::new());
        dialect.delimiter.split(first, &mut names);
        dialect.delimiter.split(second, &mut values);
        let counts = |from: usize| {
            let counted = names.iter().enumerate().filter(|(k, name)| *k > 0 || !name.is_empty());
            counted.enumerate().all(|(k, (_, name))| *name == (k + from).to_string())
        };
        let has_fractions = values.iter().skip(1).any(|value| value.contains(['.', ',']));
        if names.len() < 3 || names.len() != dialect.width || !has_fractions || !(counts(0) || counts(1)) {
            return self;
        }
        let lines = vec![first.trim_end().to_owned()];
        let names = names.iter().map(|name| ((*name).to_owned(), None)).collect();
        Self { names, line, first_row: line + 1, skipped: line - 1, lines, ..self }
    }
}

/// The lines above the rows that can name the columns, nearest first; those that say nothing are passed over.
fn candidates<'t>(lines: &[(u64, &'t str)], dialect: &Dialect) -> Vec<Candidate<'t>> {
    /// Names, units, and what else instruments add.
    const MOST: usize = 4;
    let mut found: Vec<Candidate<'t>> = Vec::new();
    // The line below the next one that could name the columns.
    let mut next = None;
    for (k, (line, text)) in lines.iter().enumerate().rev() {
        let are_units = found.last().is_none_or(|below| unit::are_mostly_units(&below.cells));
        let is_adjacent = next.is_none_or(|next| next == line + 1 || is_comment(text) || are_units);
        if found.len() == MOST || !is_adjacent {
            break;
        }
        next = Some(*line);
        let is_passed = silent::is_row(text, dialect) || are_units && silent::is(text, dialect);
        if is_passed {
            continue;
        }
        let Some(cells) = header_cells(text, dialect) else { break };
        let has_names_above = || {
            let above = k.checked_sub(1).and_then(|k| header_cells(lines[k].1, dialect));
            above.is_some_and(|above| dialect.is_wordy(&above) || silent::is_keyed(&above))
        };
        let is_keyed = || found.is_empty() && silent::is_keyed(&cells) && has_names_above();
        if keyed::are_units(&cells) || silent::is_setting(&cells) || is_keyed() {
            continue;
        }
        // Preambles have numbers where headers have names; numbers above units are names of channels.
        let is_above_units = found.last().is_none_or(|below| are_units || unit::are_units(&below.cells));
        if !dialect.is_wordy(&cells) && !is_above_units {
            break;
        }
        found.push(Candidate { line: *line, text, cells });
    }
    found
}

/// Which candidate is the row of units: all of its cells are, or most of them where those of the line above are not.
fn units(candidates: &[Candidate<'_>]) -> Option<usize> {
    let cells = |k: usize| &candidates[k].cells[..];
    let is_below_names =
        |k: &usize| candidates.get(k + 1).is_some_and(|above| unit::are_units_below(cells(*k), &above.cells));
    let all = || 0..candidates.len();
    let is_beside_names =
        |k: &usize| unit::are_units(cells(*k)) && all().any(|other| !unit::are_units(cells(other)));
    // Letters above units are names, though they may be units too: `t,V,A` above `s,V,A`.
    let is_above = |k: &usize| k + 1 < candidates.len() && unit::are_mostly_units(cells(*k));
    all().find(is_below_names).or_else(|| all().find(is_beside_names)).or_else(|| all().find(is_above))
}

/// A name as it is meant: a doubled quotation mark is one, the end of a line within a cell a blank, and apostrophes around it are none of it.
fn plain(name: &str) -> String {
    let within = name.strip_prefix('\'').and_then(|name| name.strip_suffix('\''));
    let name = within.filter(|name| !name.contains('\'')).unwrap_or(name);
    name.replace("\"\"", "\"").split_whitespace().collect::<Vec<_>>().join(" ")
}

/// From the first row to the next, in the first column.
fn step(text: &str, first_row: u64, dialect: &Dialect) -> Option<f64> {
    let rows = numbered(text).filter(|(line, text)| *line >= first_row && !is_idle(text));
    let firsts = rows.take(2).map(|(_, row)| {
        let mut cells = Vec::new();
        dialect.split(row, &mut cells);
        dialect.number(cells.first()?)
    });
    let firsts: Vec<Option<f64>> = firsts.collect();
    Some((*firsts.get(1)?)? - firsts[0]?)
}

/// How many names a line holds that stand for nothing else.
fn distinct(cells: &[&str]) -> usize {
    let is_name = |cell: &&&str| !cell.is_empty() && (cell.parse::<f64>().is_err() || cell.len() <= 2);
    cells.iter().filter(is_name).collect::<std::collections::HashSet<_>>().len()
}

/// The lines of a text; those between two quotation marks, as of a cell with lines of its own, are one with the number of the last.
fn whole(text: &str) -> impl Iterator<Item = (u64, &str)> {
    /// Lines of the longest cell, times the cells of a header.
    const MOST: usize = 200;
    let end = lines::end(text);
    let mut rest = Some(text);
    let mut number = 0;
    // A mark that begins a cell; another is a sign of inches.
    let is_open = |line: &str| {
        let marks = line.bytes().filter(|byte| *byte == b'"').count();
        let begins = |at: usize| at == 0 || line[..at].ends_with([',', ';', '\t', '|']);
        marks % 2 == 1 && line.rfind('"').is_some_and(begins)
    };
    std::iter::from_fn(move || {
        let text = rest?;
        let ends = text.match_indices(end).map(|(at, _)| at).chain(std::iter::once(text.len()));
        let first = ends.clone().next()?;
        let taken = if is_open(&text[..first]) {
            let is_whole = |line: &str| line.bytes().filter(|byte| *byte == b'"').count() % 2 == 0;
            ends.take(MOST).enumerate().find(|(_, at)| is_whole(&text[..*at]))
        } else {
            None
        };
        let (further, at) = taken.unwrap_or((0, first));
        number += 1 + further as u64;
        rest = text.get(at + 1..).filter(|_| at < text.len());
        Some((number, lines::without_return(&text[..at])))
    })
}

/// Goes down to the first row, then up again over lines that are rows with a fault, which the rows' reader will show.
fn above<'t>(text: &'t str, dialect: &Dialect) -> Above<'t> {
    let mut cells = Vec::new();
    let mut lines: Vec<(u64, &str)> = Vec::new();
    let mut first_row = None;
    for (number, line) in whole(text) {
        if line.trim().is_empty() {
            continue;
        }
        dialect.split(line, &mut cells);
        if !is_idle(line) && dialect.is_row(&cells) {
            first_row = Some(number);
            break;
        }
        lines.push((number, line));
    }
    let mut first_row = first_row.unwrap_or(u64::MAX);
    while let Some((&(number, line), further)) = lines.split_last() {
        dialect.split(line, &mut cells);
        // Where most rows leave cells out, a longer one stands below a header of that length.
        let is_headed = || further.iter().any(|(_, text)| misfit(text, dialect) == Some(cells.len()));
        let is_row = cells.len() == dialect.width || cells.len() > dialect.width && is_headed();
        let is_faulty_row = !is_idle(line) && is_row && !dialect.is_wordy(&cells);
        let is_above_blank = number + 1 < first_row && silent::is_keyed(&cells);
        if !is_faulty_row || is_above_blank || unit::are_units(&cells) || silent::is_setting(&cells) {
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
        let mut cells = dialect.form.header(line, delimiter);
        while cells.len() > dialect.width && cells.last() == Some(&"") {
            cells.pop();
        }
        // Rows that end in a delimiter have a nameless last cell; that nothing stands in it is seen once they are read.
        let is_own = delimiter == dialect.delimiter && delimiter != Delimiter::Blanks;
        if cells.len() + 1 == dialect.width && is_own && cells.len() >= 2 {
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
