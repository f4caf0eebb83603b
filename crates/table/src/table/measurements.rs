//! Measurements as columns.

use super::column::{Column, Kind};
use super::error::DataError;
use super::places::Places;

/// A file's columns, all of the same length.
#[derive(Debug, Clone)]
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
    /// The last line, where it ends in the middle of a row; such a row is left out.
    pub cut_off: Option<DataError>,
}

impl Table {
    /// All columns for a message: number, name, unit.
    pub fn listing(&self) -> String {
        let listed = self.columns.iter().enumerate().map(|(k, column)| {
            let kind = match column.kind {
                Kind::Number => "",
                Kind::Stamp => ", times",
                Kind::Text => ", text",
            };
            if self.has_header {
                format!("{} `{}`{kind}", k + 1, column.label())
            } else {
                (k + 1).to_string()
            }
        });
        listed.collect::<Vec<_>>().join(", ")
    }
}
