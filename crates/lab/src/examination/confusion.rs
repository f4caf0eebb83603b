//! What was put in against what was said.

use super::table::csv;
use crate::generate::EFFECTS;
use switchback_diagnose::Status;

/// Counts of answers (columns) by truth (rows).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Confusion {
    /// Truths: every effect where it is large, then `none` and `outside`.
    pub rows: Vec<&'static str>,
    /// Answers: every effect named alone, then `several`, every other [`Status`], and `failed`.
    pub columns: Vec<&'static str>,
    /// Counts, a row a truth.
    pub counts: Vec<Vec<usize>>,
}

impl Confusion {
    /// Counts truths with what was said of them; a truth that has no row is left out.
    pub(crate) fn of(answers: impl Iterator<Item = (&'static str, &'static str)>) -> Self {
        let rows: Vec<_> = EFFECTS.into_iter().chain(["none", "outside"]).collect();
        let others = Status::ALL.into_iter().filter(|status| *status != Status::Named).map(Status::name);
        let columns: Vec<_> =
            EFFECTS.into_iter().chain(["several"]).chain(others).chain(["failed"]).collect();
        let mut counts = vec![vec![0; columns.len()]; rows.len()];
        for (truth, said) in answers {
            let row = rows.iter().position(|row| *row == truth);
            let column = columns.iter().position(|column| *column == said);
            if let (Some(row), Some(column)) = (row, column) {
                counts[row][column] += 1;
            }
        }
        Self { rows, columns, counts }
    }

    /// The table as CSV.
    pub(crate) fn csv(&self) -> String {
        let header: Vec<&str> = std::iter::once("truth").chain(self.columns.iter().copied()).collect();
        let rows = self.rows.iter().zip(&self.counts).map(|(truth, counts)| {
            std::iter::once((*truth).to_owned()).chain(counts.iter().map(usize::to_string)).collect()
        });
        csv(&header, rows)
    }
}
