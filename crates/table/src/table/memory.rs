//! Tables whose columns are in memory already.

use super::body::Reader;
use super::cell::Decimal;
use super::column::{Column, Fault, Kind, empty_column};
use super::error::Place;
use super::measurements::Table;
use super::unit;

/// The cells of one column.
#[derive(Debug, Clone, PartialEq)]
pub enum Cells {
    /// Numbers; NaN where nothing was measured.
    Numbers(Vec<f64>),
    /// Texts as they would stand in a file: numbers, ISO 8601 times, words; empty where nothing was measured.
    Texts(Vec<String>),
}

impl Cells {
    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        match self {
            Self::Numbers(numbers) => numbers.len(),
            Self::Texts(texts) => texts.len(),
        }
    }
}

impl Table {
    /// The table of columns of one length, with their labels. Cells are judged as those of a file are.
    pub fn of_columns(name: &str, columns: Vec<(String, Cells)>) -> Self {
        let columns: Vec<Column> = columns.into_iter().map(column).collect();
        let rows = columns.first().map_or(0, |column| column.values.len());
        Self {
            path: name.to_owned(),
            columns,
            places: (1..=rows as u64).map(Place::Row).collect(),
            has_header: true,
            ..Self::default()
        }
    }
}

fn column((label, cells): (String, Cells)) -> Column {
    let (name, unit) = unit::split(&label);
    let mut column = empty_column(name, unit);
    match cells {
        Cells::Numbers(numbers) => take_numbers(&mut column, numbers),
        Cells::Texts(texts) => {
            let mut reader = Reader::default();
            for (row, text) in texts.iter().enumerate() {
                reader.push(&mut column, row, text, Decimal::Point);
            }
        }
    }
    column
}

/// An infinite number is a fault, as it is in a file.
fn take_numbers(column: &mut Column, mut numbers: Vec<f64>) {
    for (row, number) in numbers.iter_mut().enumerate().filter(|(_, number)| number.is_infinite()) {
        column.add_fault(Fault { row, cell: number.to_string() });
        *number = f64::NAN;
    }
    column.kind = Kind::Number;
    column.values = numbers;
}
