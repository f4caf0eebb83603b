//! How a text separates its cells and writes its numbers.

use super::cell::{self, Cell, Decimal};
use super::form::Form;
use super::lines::{Delimiter, is_idle, numbered};
use std::collections::HashMap;

/// How a text separates its cells and writes its numbers, and what its rows look like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Dialect {
    pub(super) delimiter: Delimiter,
    pub(super) decimal: Decimal,
    /// Cells of a row.
    pub(super) width: usize,
    /// What a row holds beside its values.
    pub(super) form: Form,
    /// Cells of a typical row that are text.
    texts: usize,
    /// Whether numbers have their units behind them.
    has_quantities: bool,
}

/// In the order of preference where several read the text equally well. Blanks come last, since they surround other signs too; commas
/// that separate and are decimal can only be distinguished by quotation marks.
const CANDIDATES: [(Delimiter, Decimal); 10] = [
    (Delimiter::Sign('\t'), Decimal::Point),
    (Delimiter::Sign('\t'), Decimal::Comma),
    (Delimiter::Sign(';'), Decimal::Point),
    (Delimiter::Sign(';'), Decimal::Comma),
    (Delimiter::Sign('|'), Decimal::Point),
    (Delimiter::Sign('|'), Decimal::Comma),
    (Delimiter::Sign(','), Decimal::Point),
    (Delimiter::Sign(','), Decimal::Comma),
    (Delimiter::Blanks, Decimal::Point),
    (Delimiter::Blanks, Decimal::Comma),
];

/// Lines looked at, and how many of them, the last, count: what stands above the table is among the others.
const LOOKED_AT: usize = 2000;
const COUNTED: usize = 400;

impl Dialect {
    /// The dialect in which most cells of the text are numbers; none where no two columns of numbers appear in any.
    pub(super) fn of(text: &str) -> Option<Self> {
        let lines: Vec<&str> =
            numbered(text).map(|(_, line)| line).filter(|line| !is_idle(line)).take(LOOKED_AT).collect();
        let counted = &lines[lines.len().saturating_sub(COUNTED)..];
        let mut best: Option<(f64, Self)> = None;
        for form in Form::in_lines(counted) {
            for (delimiter, decimal) in CANDIDATES {
                if let Some((score, dialect)) = judged(counted, (delimiter, decimal), form)
                    && best.as_ref().is_none_or(|(most, _)| score > *most)
                {
                    best = Some((score, dialect));
                }
            }
        }
        best.map(|(_, dialect)| dialect)
    }

    /// Whether a text that goes on shows as many lines as are looked at, all of them whole.
    pub(super) fn is_seen_in(text: &str) -> bool {
        let lines = numbered(text).filter(|(_, line)| !is_idle(line));
        lines.take(LOOKED_AT + 1).count() > LOOKED_AT
    }

    /// A single column of numbers; none where less than half of the lines are numbers.
    pub(super) fn single(text: &str) -> Option<Self> {
        let lines: Vec<&str> = numbered(text).map(|(_, line)| line).filter(|line| !is_idle(line)).collect();
        let is_number = |line: &&&str| matches!(cell::read(line.trim(), Decimal::Point), Cell::Number(_));
        let numbers = lines.iter().filter(is_number).count();
        let (delimiter, decimal, form) = (Delimiter::Sign(','), Decimal::Point, Form::default());
        let single = Self { delimiter, decimal, width: 1, form, texts: 0, has_quantities: false };
        (2 * numbers > lines.len()).then_some(single)
    }

    /// Splits a line into its cells; `cells` is emptied first.
    pub(super) fn split<'t>(&self, line: &'t str, cells: &mut Vec<&'t str>) {
        self.form.split(line, self.delimiter, cells);
    }

    /// The number in a cell.
    pub(super) fn number(&self, cell: &str) -> Option<f64> {
        match cell::read(cell, self.decimal) {
            Cell::Number(value) | Cell::Quantity(value) => Some(value),
            _ => None,
        }
    }

    /// Whether cells could be a row of the table, rather than its header or what stands above.
    pub(super) fn is_row(&self, cells: &[&str]) -> bool {
        let count = self.count(cells);
        cells.len() == self.width && count.numbers >= 1 && count.texts <= self.texts
    }

    /// Whether most cells are words, as in a header.
    pub(super) fn is_wordy(&self, cells: &[&str]) -> bool {
        let count = self.count(cells);
        count.texts > count.numbers
    }

    /// Where no row holds units, a number with a unit stands above the table.
    fn count(&self, cells: &[&str]) -> Count {
        let count = Count::of(cells, self.decimal);
        if self.has_quantities { count } else { count.without_quantities() }
    }
}

#[derive(Clone, Copy)]
struct Count {
    numbers: usize,
    texts: usize,
    /// Numbers with units.
    quantities: usize,
}

impl Count {
    fn of(cells: &[&str], decimal: Decimal) -> Self {
        let mut count = Self { numbers: 0, texts: 0, quantities: 0 };
        for text in cells {
            let cell = cell::read(text, decimal);
            count.numbers += usize::from(!matches!(cell, Cell::Text | Cell::Missing));
            count.texts += usize::from(cell == Cell::Text);
            count.quantities += usize::from(matches!(cell, Cell::Quantity(_)));
        }
        count
    }

    /// Numbers with units taken as texts.
    fn without_quantities(self) -> Self {
        let Self { numbers, texts, quantities } = self;
        Self { numbers: numbers - quantities, texts: texts + quantities, quantities: 0 }
    }
}

/// The mean share of numbers among the cells that say something, over lines of the commonest width.
fn judged(lines: &[&str], (delimiter, decimal): (Delimiter, Decimal), form: Form) -> Option<(f64, Dialect)> {
    let mut cells = Vec::new();
    let mut counts: Vec<(usize, Count)> = Vec::with_capacity(lines.len());
    for line in lines {
        form.split(line, delimiter, &mut cells);
        let mut count = Count::of(&cells, decimal);
        // Among blanks `5s` is a word of a sentence.
        if delimiter == Delimiter::Blanks {
            count = count.without_quantities();
        }
        if cells.len() >= 2 && count.numbers >= 1 {
            counts.push((cells.len(), count));
        }
    }
    if form.is_named() && !have_names(lines, delimiter, form) {
        return None;
    }
    let mut widths: HashMap<usize, usize> = HashMap::new();
    for (width, _) in &counts {
        *widths.entry(*width).or_default() += 1;
    }
    let (&width, _) = widths.iter().max_by_key(|(width, times)| (**times, **width))?;
    let rows: Vec<Count> = counts.into_iter().filter(|(w, _)| *w == width).map(|(_, count)| count).collect();
    let share = |count: &Count| count.numbers as f64 / (count.numbers + count.texts) as f64;
    let score = rows.iter().map(share).sum::<f64>() / lines.len() as f64;
    let mut texts: Vec<usize> = rows.iter().map(|count| count.texts).collect();
    texts.sort_unstable();
    let texts = texts[texts.len() / 2];
    let has_two = rows.iter().any(|count| count.numbers >= 2);
    let has_quantities = 2 * rows.iter().filter(|count| count.quantities > 0).count() > rows.len();
    has_two.then_some((score, Dialect { delimiter, decimal, width, form, texts, has_quantities }))
}

/// Whether most lines that hold names hold the same ones.
fn have_names(lines: &[&str], delimiter: Delimiter, form: Form) -> bool {
    let names = |line: &&str| -> Vec<String> {
        let pairs = form.pairs(line, delimiter).into_iter();
        pairs.map(|(name, _)| name.to_owned()).filter(|name| !name.is_empty()).collect()
    };
    let all: Vec<Vec<String>> = lines.iter().map(names).filter(|names| names.len() >= 2).collect();
    let usual = all.get(all.len() / 2);
    2 * all.iter().filter(|names| Some(*names) == usual).count() > all.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn read_as(text: &str, delimiter: Delimiter, decimal: Decimal, width: usize) {
        let dialect = Dialect::of(text).expect("a table");
        assert_eq!(
            (dialect.delimiter, dialect.decimal, dialect.width),
            (delimiter, decimal, width),
            "{text}"
        );
    }

    #[test]
    fn signs_and_decimals_are_recognised() {
        read_as("t,v\n0.1,2\n0.2,3\n", Delimiter::Sign(','), Decimal::Point, 2);
        read_as("t;v\n0,1;2,5\n0,2;3\n", Delimiter::Sign(';'), Decimal::Comma, 2);
        read_as("0.1, 2.0, 3\n0.2, 3.0, 4\n", Delimiter::Sign(','), Decimal::Point, 3);
        read_as("0,1\t2,5\n0,2\t3\n", Delimiter::Sign('\t'), Decimal::Comma, 2);
        read_as("0,1   2,5\n0,2   3\n", Delimiter::Blanks, Decimal::Comma, 2);
        read_as("\"0,1\",\"2,5\"\n\"0,2\",\"3\"\n", Delimiter::Sign(','), Decimal::Comma, 2);
        read_as("1,2,OK\n2,3,OK\n", Delimiter::Sign(','), Decimal::Point, 3);
        read_as(
            "2024-01-01 10:00:00;1,5\n2024-01-01 10:00:01;2,5\n",
            Delimiter::Sign(';'),
            Decimal::Comma,
            2,
        );
    }

    #[test]
    fn prose_is_no_table() {
        assert_eq!(Dialect::of("This is\na letter, nothing more.\n"), None);
    }
}
