//! Where a table begins and what its columns are called.

use super::dialect::Dialect;
use super::error::{DataProblem, Place};
use super::lines::{Delimiter, is_comment, is_idle, numbered};
use super::{preamble, unit};

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
    /// The lines of names and units, as they stand in the file.
    pub(super) lines: Vec<String>,
    /// Seconds between rows, where a line above them says so.
    pub(super) increment: Option<f64>,
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

impl Head {
    /// Where the header has more cells than the rows, the dialect takes its width: cells at the end of rows may be left out.
    ///
    /// # Errors
    /// A header that has fewer cells than the rows.
    pub(super) fn find(text: &str, dialect: &mut Dialect) -> Result<Self, (Place, DataProblem)> {
        let Above { lines: all, first_row } = above(text, dialect);
        let increment = preamble::increment(&all);
        // A comment names the columns only where no other line does.
        let plain: Vec<_> = all.iter().copied().filter(|(_, line)| !is_comment(line)).collect();
        let nearest = plain.last().map(|(_, line)| *line);
        let is_named = nearest.is_some_and(|line| header_cells(line, dialect).is_some());
        if let Some(width) = nearest.filter(|_| !is_named).and_then(|line| misfit(line, dialect))
            && width > dialect.width
        {
            dialect.width = width;
            return Self::named(plain, dialect, Self { first_row, increment, ..Self::default() });
        }
        let lines = if is_named { plain } else { all };
        Self::named(lines, dialect, Self { first_row, increment, ..Self::default() })
            .map(|head| if head.names.is_empty() { head.numbered(text, dialect) } else { head })
    }

    fn named(lines: Vec<(u64, &str)>, dialect: &Dialect, head: Self) -> Result<Self, (Place, DataProblem)> {
        let Some((line, nearest)) = lines.last() else { return Ok(head) };
        if let Some(described) = described(&lines, dialect) {
            return Ok(Self { names: described, skipped: *line, line: *line, ..head });
        }
        let candidates = candidates(&lines, dialect);
        if candidates.is_empty() {
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
        }
        Ok(Self::of_candidates(&candidates, head))
    }

    /// The line with the most distinct names is the header; of several the nearest, unless it holds nothing but units.
    fn of_candidates(candidates: &[Candidate<'_>], head: Self) -> Self {
        let is_units = |candidate: &Candidate<'_>| unit::are_units(&candidate.cells);
        let rank = |(k, candidate): &(usize, &Candidate<'_>)| {
            (!is_units(candidate), distinct(&candidate.cells), std::cmp::Reverse(*k))
        };
        let best = candidates.iter().enumerate().max_by_key(rank).map_or(0, |(k, _)| k);
        let names = &candidates[best];
        let units = candidates.iter().enumerate().find(|(k, candidate)| *k != best && is_units(candidate));
        let cell_of = |k: usize| units.and_then(|(_, units)| unit::bare(units.cells.get(k)?));
        let named = names.cells.iter().enumerate().map(|(k, name)| {
            let (name, own) = unit::split(name);
            (name, cell_of(k).or(own))
        });
        let beside = candidates.iter().filter(|other| other.line != names.line);
        let increment = beside
            .flat_map(|other| names.cells.iter().zip(&other.cells))
            .find_map(|(name, value)| preamble::entry(name, value));
        let taken = [Some(names), units.map(|(_, units)| units)];
        Self {
            names: named.collect(),
            has_unit_row: units.is_some(),
            line: names.line,
            skipped: candidates
                .last()
                .map_or(0, |top| top.line.min(names.line))
                .min(units.map_or(names.line, |(_, units)| units.line.min(names.line)))
                - 1,
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

/// The lines right above the rows that can name the columns, nearest first.
fn candidates<'t>(lines: &[(u64, &'t str)], dialect: &Dialect) -> Vec<Candidate<'t>> {
    /// Names, units, and what else instruments add.
    const MOST: usize = 4;
    let mut found: Vec<Candidate<'t>> = Vec::new();
    for (line, text) in lines.iter().rev().take(MOST) {
        let Some(cells) = header_cells(text, dialect) else { break };
        let is_adjacent = found.last().is_none_or(|below| below.line == line + 1 || is_comment(text));
        // Preambles have numbers where headers have names; numbers above units are names of channels.
        let is_wordy =
            dialect.is_wordy(&cells) || found.last().is_none_or(|below| unit::are_units(&below.cells));
        if !is_adjacent || !is_wordy {
            break;
        }
        found.push(Candidate { line: *line, text, cells });
    }
    found
}

/// How many names a line holds that stand for nothing else.
fn distinct(cells: &[&str]) -> usize {
    let is_name = |cell: &&&str| !cell.is_empty() && (cell.parse::<f64>().is_err() || cell.len() <= 2);
    cells.iter().filter(is_name).collect::<std::collections::HashSet<_>>().len()
}

/// Names and units in comments that repeat a key before every one: `name: Time  name: Force`.
fn described(lines: &[(u64, &str)], dialect: &Dialect) -> Option<Vec<(String, Option<String>)>> {
    let values = |word: &str| {
        lines.iter().rev().find_map(|(_, line)| {
            let cells = pairs(line, dialect.width)?;
            cells
                .iter()
                .all(|(key, _)| key.to_lowercase().contains(word))
                .then(|| cells.into_iter().map(|(_, value)| value).collect::<Vec<_>>())
        })
    };
    let (names, units) = (values("name")?, values("unit"));
    let unit = |k: usize| units.as_ref().and_then(|units| unit::bare(units[k]));
    Some(names.iter().enumerate().map(|(k, name)| ((*name).to_owned(), unit(k))).collect())
}

/// The keys and values of a comment that has as many as there are columns.
fn pairs(line: &str, width: usize) -> Option<Vec<(&str, &str)>> {
    let bare = line.trim_start().trim_start_matches(['#', '%', '/', ' ']);
    let cells: Vec<&str> = bare.split("  ").map(str::trim).filter(|cell| !cell.is_empty()).collect();
    let pairs: Vec<(&str, &str)> = match cells.len() == width {
        true => cells
            .iter()
            .filter_map(|cell| cell.split_once(':'))
            .map(|(key, value)| (key, value.trim()))
            .collect(),
        false => {
            cells.chunks_exact(2).filter_map(|pair| Some((pair[0].strip_suffix(':')?, pair[1]))).collect()
        }
    };
    let are_alike = pairs.iter().all(|(key, _)| *key == pairs[0].0);
    (pairs.len() == width && width > 1 && are_alike).then_some(pairs)
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
    while let Some((&(number, line), further)) = lines.split_last() {
        dialect.delimiter.split(line, &mut cells);
        // Where most rows leave cells out, a longer one stands below a header of that length.
        let is_headed = || further.iter().any(|(_, text)| misfit(text, dialect) == Some(cells.len()));
        let is_row = cells.len() == dialect.width || cells.len() > dialect.width && is_headed();
        let is_faulty_row = !is_idle(line) && is_row && !dialect.is_wordy(&cells);
        if !is_faulty_row || unit::are_units(&cells) {
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
