//! Measurements as columns.

use super::column::{Column, Kind, empty_column};
use super::error::DataError;
use super::places::Places;

/// A file's columns, all of the same length.
#[derive(Debug, Clone, Default)]
pub struct Table {
    /// The file, as messages call it.
    pub path: String,
    /// In the order of the file.
    pub columns: Vec<Column>,
    /// Where each row stands.
    pub places: Places,
    /// Whether the names of the columns are the file's own.
    pub has_header: bool,
    /// What was recognised and is not how such files usually look.
    pub notes: Vec<String>,
    /// Rows that could not be read.
    pub faults: Vec<DataError>,
    /// Rows before which the header stands again.
    pub breaks: Vec<usize>,
    /// Seconds between rows by what stands above the table.
    pub increment: Option<f64>,
    /// The last line, where it ends in the middle of a row; such a row is left out.
    pub cut_off: Option<DataError>,
}

impl Table {
    /// Its rows as a table of their own; the columns stay, as far as they are known.
    pub(super) fn take_rows(&mut self) -> Self {
        let empty = self.columns.iter().map(|column| Column {
            kind: column.kind,
            origin: column.origin,
            words: column.words.clone(),
            has_units: column.has_units,
            ..empty_column(column.name.clone(), column.unit.clone())
        });
        let empty = empty.collect();
        Self {
            path: self.path.clone(),
            columns: std::mem::replace(&mut self.columns, empty),
            places: std::mem::take(&mut self.places),
            has_header: self.has_header,
            notes: self.notes.clone(),
            breaks: std::mem::take(&mut self.breaks),
            increment: self.increment,
            ..Self::default()
        }
    }

    /// Takes the last row back.
    pub(super) fn drop_last_row(&mut self) {
        let Some(row) = self.places.len().checked_sub(1) else { return };
        self.places.truncate(row);
        for column in &mut self.columns {
            column.values.truncate(row);
            column.stamps.truncate(row);
            column.codes.truncate(row);
            if column.faults.last().is_some_and(|fault| fault.row == row) {
                column.faults.pop();
                column.fault_count -= 1;
            }
        }
    }

    /// All columns for a message: number, name, unit.
    pub fn listing(&self) -> String {
        let listed = self.columns.iter().enumerate().map(|(k, column)| {
            let kind = match column.kind {
                Kind::Number => "",
                Kind::Stamp => ", times",
                Kind::Text => ", text",
            };
            if self.has_header && column.name.is_empty() {
                format!("{} without a name{kind}", k + 1)
            } else if self.has_header {
                format!("{} `{}`{kind}", k + 1, column.label())
            } else {
                (k + 1).to_string()
            }
        });
        listed.collect::<Vec<_>>().join(", ")
    }
}
