//! What was put in against what was said.

use crate::blind::case::Case;
use crate::blind::design::Kind;
use crate::examination::csv;
use crate::generate::EFFECTS;

/// Counts of answers (columns) by truth (rows).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Confusion {
    /// Truths: every effect at a size of at least 1, then `none` and `outside`.
    pub rows: Vec<&'static str>,
    /// Answers: every effect named alone, then `several`, `class`, `ambiguous`, `none`, `refit` where parameters may be all
    /// that has changed, `unexplained`, `failed`.
    pub columns: Vec<&'static str>,
    /// Counts, a row a truth.
    pub counts: Vec<Vec<usize>>,
}

impl Confusion {
    /// The table as CSV.
    pub fn csv(&self) -> String {
        let header: Vec<&str> = std::iter::once("truth").chain(self.columns.iter().copied()).collect();
        let rows = self.rows.iter().zip(&self.counts).map(|(truth, counts)| {
            std::iter::once((*truth).to_owned()).chain(counts.iter().map(usize::to_string)).collect()
        });
        csv(&header, rows)
    }
}

pub(super) fn confusion(cases: &[Case]) -> Confusion {
    let rows: Vec<_> = EFFECTS.into_iter().chain(["none", "outside"]).collect();
    let rest = ["several", "class", "ambiguous", "none", "unexplained", "failed"];
    let columns: Vec<_> = EFFECTS.into_iter().chain(rest).collect();
    let mut counts = vec![vec![0; columns.len()]; rows.len()];
    for case in cases {
        let truth = match case.kind {
            Kind::Single if case.is_large() => case.truth[0],
            Kind::None => "none",
            Kind::Outside => "outside",
            Kind::Single | Kind::Pair => continue,
        };
        let said = match (case.reply.status, case.reply.effects.as_slice()) {
            ("named", [one]) => one,
            ("named", _) => "several",
            (status, _) => status,
        };
        let row = rows.iter().position(|r| *r == truth);
        let column = columns.iter().position(|c| *c == said);
        if let (Some(row), Some(column)) = (row, column) {
            counts[row][column] += 1;
        }
    }
    Confusion { rows, columns, counts }
}
