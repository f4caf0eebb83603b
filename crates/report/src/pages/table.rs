//! Tables that a reader may sort.

use maud::{Markup, html};
use switchback_io::output::number;

/// A cell: what is read, and the number that it is sorted by.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cell {
    text: String,
    number: Option<f64>,
    is_number: bool,
}

impl Cell {
    /// A word.
    pub(super) fn word(text: impl Into<String>) -> Self {
        Self { text: text.into(), number: None, is_number: false }
    }

    /// A number as it is reported; `None` comes last however the table is sorted.
    pub(super) fn number(text: impl Into<String>, number: Option<f64>) -> Self {
        Self { text: signed(&text.into()), number: number.filter(|x| x.is_finite()), is_number: true }
    }
}

/// Hyphens before digits are minus signs.
fn signed(text: &str) -> String {
    let mut letters = text.chars().peekable();
    let mut signed = String::with_capacity(text.len());
    while let Some(letter) = letters.next() {
        let is_minus = letter == '-' && letters.peek().is_some_and(char::is_ascii_digit);
        signed.push(if is_minus { '−' } else { letter });
    }
    signed
}

/// A table: columns and rows as long as these.
pub(super) struct Table {
    caption: String,
    head: Vec<String>,
    rows: Vec<Vec<Cell>>,
}

impl Table {
    /// An empty table.
    pub(super) fn new<const N: usize>(caption: impl Into<String>, head: [&str; N]) -> Self {
        Self::of(caption, &head)
    }

    /// The same of as many columns as there are.
    pub(super) fn of(caption: impl Into<String>, head: &[&str]) -> Self {
        let head = head.iter().map(|name| (*name).to_owned()).collect();
        Self { caption: caption.into(), head, rows: Vec::new() }
    }

    /// Another row.
    pub(super) fn row(&mut self, cells: impl Into<Vec<Cell>>) {
        let cells = cells.into();
        debug_assert_eq!(cells.len(), self.head.len(), "a cell a column");
        self.rows.push(cells);
    }

    /// The same without its first column where that says the same in every row.
    pub(super) fn without_constant(mut self) -> Self {
        let is_constant = self.rows.windows(2).all(|pair| pair[0][0] == pair[1][0]);
        if is_constant && !self.rows.is_empty() {
            self.head.remove(0);
            self.rows.iter_mut().for_each(|row| _ = row.remove(0));
        }
        self
    }

    /// The table in a frame that scrolls where it is wider than the page.
    pub(super) fn html(&self) -> Markup {
        if self.rows.is_empty() {
            return html! {};
        }
        let is_numeric = |column: usize| self.rows.iter().any(|row| row[column].is_number);
        html! {
            div class="scroll" tabindex="0" role="region" aria-label=(self.caption) {
                table class="sortable" {
                    caption { (self.caption) }
                    thead { tr {
                        @for (column, name) in self.head.iter().enumerate() {
                            th scope="col" class=[is_numeric(column).then_some("n")] { (name) }
                        }
                    } }
                    tbody {
                        @for row in &self.rows {
                            tr { @for (column, cell) in row.iter().enumerate() {
                                td class=[is_numeric(column).then_some("n")] data-v=[cell.number.map(number)] { (cell.text) }
                            } }
                        }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_escaped_and_keep_the_number_they_are_sorted_by() {
        let mut table = Table::new("what <it> is", ["name", "value"]);
        table.row([Cell::word("<script>-1"), Cell::number("1.5 [-1e-2, 2]", Some(1.5))]);
        let html = table.html().into_string();
        assert!(
            html.contains("&lt;script&gt;-1") && html.contains("[−1e−2, 2]") && !html.contains("<script>")
        );
        assert!(html.contains("data-v=\"1.5\"") && html.contains("what &lt;it&gt; is"));
    }

    #[test]
    fn a_column_that_says_nothing_is_left_out() {
        let html = |second: &str| {
            let mut table = Table::new("", ["case", "value"]);
            table.row([Cell::word("first"), Cell::word("1")]);
            table.row([Cell::word(second), Cell::word("2")]);
            table.without_constant().html().into_string()
        };
        assert!(!html("first").contains("case") && html("second").contains("case"));
    }

    #[test]
    fn a_table_without_rows_is_nothing() {
        assert_eq!(Table::new("none", ["a"]).html().into_string(), "");
    }
}
