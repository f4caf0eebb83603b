//! Cells that are neither a value nor missing.

use crate::table::{Column, DataProblem, Kind};

/// What is wrong in a column, by row. `no_times` is the remedy where it is the time column and holds text.
pub(super) fn of(column: &Column, no_times: Option<String>) -> Vec<(usize, DataProblem)> {
    let reported = |cell: &str| match (column.kind, &no_times) {
        (Kind::Stamp, _) => DataProblem::NotAStamp { column: column.label(), cell: cell.to_owned() },
        (Kind::Text, Some(remedy)) => {
            DataProblem::NotATime { column: column.label(), cell: cell.to_owned(), remedy: remedy.clone() }
        }
        _ => fault(column, cell),
    };
    let mut problems: Vec<(usize, DataProblem)> =
        column.faults.iter().map(|fault| (fault.row, reported(&fault.cell))).collect();
    let count = column.fault_count - column.faults.len();
    if let (Some((row, last)), true) = (problems.last(), count > 0) {
        let remedy = last.remedy();
        problems.push((*row, DataProblem::More { column: column.label(), count, remedy }));
    }
    problems
}

/// What is wrong with a cell that holds no value, by its text.
fn fault(column: &Column, cell: &str) -> DataProblem {
    let has_other_unit = column.has_other_unit(cell);
    let (column, cell) = (column.label(), cell.to_owned());
    if has_other_unit {
        return DataProblem::OtherUnit { column, cell };
    }
    let is_finite = |text: &str| text.parse::<f64>().is_ok_and(f64::is_finite);
    match cell.parse::<f64>() {
        // A point is read wherever it is the file's own sign.
        Ok(x) if x.is_finite() => DataProblem::OtherDecimal { column, cell, found: "point" },
        Ok(_) => DataProblem::NotFinite { column, cell },
        Err(_) if !cell.contains('.') && is_finite(&cell.replacen(',', ".", 1)) => {
            DataProblem::OtherDecimal { column, cell, found: "comma" }
        }
        Err(_) => DataProblem::NotANumber { column, cell },
    }
}
