//! Tables of a report: the same cells make its CSV, its JSON, its pages and its figures.

use super::share::Share;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use switchback_io::input::nullable;
use switchback_io::output::csv_cell;

/// A cell of a table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Cell {
    /// Yes or no.
    Flag(bool),
    /// How many.
    Count(usize),
    /// A number as it was given.
    Given(f64),
    /// A share.
    Share(Share),
    /// A word.
    Word(String),
    /// A number that was computed: four decimals of it are reported.
    Figure(#[serde(deserialize_with = "nullable::number")] f64),
}

impl Cell {
    /// A word.
    pub(crate) fn word(text: impl Into<String>) -> Self {
        Self::Word(text.into())
    }

    /// The number; none of words and shares.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Count(count) => Some(*count as f64),
            Self::Given(x) | Self::Figure(x) => Some(*x),
            Self::Flag(_) | Self::Share(_) | Self::Word(_) => None,
        }
    }

    /// As a field of a CSV table; a share of nothing is empty.
    fn field(&self) -> String {
        match self {
            Self::Flag(flag) => flag.to_string(),
            Self::Count(count) => count.to_string(),
            Self::Given(x) => x.to_string(),
            Self::Share(share) => share.value().map_or_else(String::new, |x| format!("{x:.4}")),
            Self::Word(word) => word.clone(),
            Self::Figure(x) => format!("{x:.4}"),
        }
    }
}

/// Cells by the names of their columns.
pub type Row = BTreeMap<String, Cell>;

/// Rows of the same columns.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Table {
    /// Its rows.
    pub rows: Vec<Row>,
}

/// A column of a table made from items of type `R`: its name, and its cell of an item.
pub(crate) type Column<'n, R> = (&'n str, fn(&R) -> Cell);

impl Table {
    /// A row an item.
    pub(crate) fn of<R>(items: impl IntoIterator<Item = R>, columns: &[Column<'_, R>]) -> Self {
        let row = |item: R| columns.iter().map(|(name, cell)| ((*name).to_owned(), cell(&item))).collect();
        Self { rows: items.into_iter().map(row).collect() }
    }

    /// The same with one column more.
    pub(crate) fn with(&self, name: &str, cell: impl Fn(&Row) -> Cell) -> Self {
        let row = |row: &Row| row.clone().into_iter().chain([(name.to_owned(), cell(row))]).collect();
        Self { rows: self.rows.iter().map(row).collect() }
    }

    /// Some of its columns as CSV: what they are called there, and here.
    pub(crate) fn csv(&self, columns: &[(&str, &str)]) -> String {
        let header: Vec<&str> = columns.iter().map(|(head, _)| *head).collect();
        let row = |row: &Row| columns.iter().map(|(_, name)| row[*name].field()).collect();
        csv(&header, self.rows.iter().map(row))
    }

    /// Whether there is nothing in it.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// A share of a row; of nothing where the column holds none.
    pub fn share(row: &Row, name: &str) -> Share {
        match row.get(name) {
            Some(Cell::Share(share)) => *share,
            _ => Share::default(),
        }
    }
}

/// Items by a key, in the order of the keys; items without a key are left out.
pub(crate) fn grouped<R, K: Ord>(
    items: impl IntoIterator<Item = R>,
    key: impl Fn(&R) -> Option<K>,
) -> Vec<(K, Vec<R>)> {
    let mut groups: BTreeMap<K, Vec<R>> = BTreeMap::new();
    for item in items {
        if let Some(key) = key(&item) {
            groups.entry(key).or_default().push(item);
        }
    }
    groups.into_iter().collect()
}

/// A table as CSV.
///
/// # Panics
/// If a row is not as long as the header.
pub fn csv(header: &[&str], rows: impl Iterator<Item = Vec<String>>) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(header).expect("writing to memory");
    for row in rows {
        let row = row.iter().map(|cell| csv_cell(cell));
        writer.write_record(row).expect("writing to memory, each row as long as the header");
    }
    String::from_utf8(writer.into_inner().expect("writing to memory")).expect("every field is UTF-8")
}
