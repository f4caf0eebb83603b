//! A column of a table.

use super::cell::{self, Cell, Decimal};

/// One column.
#[derive(Debug, Clone)]
pub struct Column {
    /// Its name without the unit; `column 2` where the file has no header.
    pub name: String,
    /// Its unit; empty for a pure number.
    pub unit: Option<String>,
    /// Whether its numbers have their unit behind them in the file.
    pub has_units: bool,
    /// Form of `model`.
    pub kind: Kind,
    /// One a row; NaN where nothing was measured or the cell is a fault. Stamps are in seconds since the first.
    pub values: Vec<f64>,
    /// The cells as they stand in the file, of stamps and of numbers with too many digits only.
    pub stamps: Vec<String>,
    /// What was subtracted: of stamps the nanoseconds of the first; of whole numbers with more digits than a value keeps the first, once they are
    /// [`exact`](Self::exact).
    pub origin: i128,
    /// The words of a column of text, as far as they are few, in the order of their first cells.
    pub words: Vec<String>,
    /// Of a column of few words the one of each row, counted from 1; 0 where there is none.
    pub codes: Vec<u8>,
    /// The first cells that are neither a value nor missing.
    pub faults: Vec<Fault>,
    /// How many such cells there are.
    pub fault_count: usize,
}

/// What the cells of a column are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A number.
    Number,
    /// A time stamp.
    Stamp,
    /// Text.
    Text,
}

/// A cell that cannot be read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    pub row: usize,
    pub cell: String,
}

impl Column {
    /// `force [N]`, or the name alone.
    pub fn label(&self) -> String {
        match &self.unit {
            Some(unit) => format!("{} [{unit}]", self.name),
            None => self.name.clone(),
        }
    }

    /// Takes the first number off all others, where they have more digits than a value keeps: their differences are then exact.
    pub fn exact(&mut self) {
        if self.kind != Kind::Number || self.stamps.is_empty() || self.origin != 0 {
            return;
        }
        let numbers: Vec<Option<i128>> = self.stamps.iter().map(|cell| cell.parse().ok()).collect();
        let Some(origin) = numbers.iter().flatten().next().copied() else { return };
        for (value, number) in self.values.iter_mut().zip(numbers) {
            *value = number.map_or(*value - origin as f64, |number| (number - origin) as f64);
        }
        self.origin = origin;
    }

    /// Whether it holds numbers that can be an input or output, or cells that are meant as such.
    pub fn is_number(&self) -> bool {
        let is_meant = || !self.faults.is_empty() || self.values.iter().any(|value| value.is_finite());
        self.kind == Kind::Number && is_meant()
    }

    /// Whether a cell that gave no value is a number in another unit than the others, or in none.
    pub(crate) fn has_other_unit(&self, cell: &str) -> bool {
        [Decimal::Point, Decimal::Comma].into_iter().any(|decimal| match cell::read(cell, decimal) {
            Cell::Number(value) => self.has_units && value.is_finite(),
            Cell::Quantity(_) => true,
            _ => false,
        })
    }

    /// A cell as it stands in the file, a number up to zeros that say nothing.
    pub fn written(&self, row: usize) -> String {
        self.stamps.get(row).cloned().unwrap_or_else(|| self.values[row].to_string())
    }
}

pub(crate) fn empty_column(name: String, unit: Option<String>) -> Column {
    Column {
        name,
        unit,
        has_units: false,
        kind: Kind::Number,
        values: Vec::new(),
        stamps: Vec::new(),
        origin: 0,
        words: Vec::new(),
        codes: Vec::new(),
        faults: Vec::new(),
        fault_count: 0,
    }
}
