//! The grid of the design, and how each cell came out.

use super::answer::distinct;
use maud::{Markup, html};
use std::collections::BTreeMap;
use switchback_study::results::{Cell, Results, Series};

/// What became of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Status {
    /// Every replicate gave an estimate, and it is as precise as asked.
    Whole,
    /// Not as precise as asked.
    Imprecise,
    /// Replicates without an estimate.
    Failures(usize),
}

impl Status {
    fn of(cell: &Cell) -> Self {
        match cell.failures.count {
            0 if cell.precise == Some(false) => Self::Imprecise,
            0 => Self::Whole,
            count => Self::Failures(count),
        }
    }

    fn class(self) -> &'static str {
        match self {
            Self::Whole => "ok",
            Self::Imprecise => "some",
            Self::Failures(_) => "no",
        }
    }

    fn reported(self, replicates: usize) -> String {
        match self {
            Self::Whole => format!("{replicates}"),
            Self::Imprecise => format!("{replicates} ≈"),
            Self::Failures(count) => format!("{replicates} − {count}"),
        }
    }
}

/// One table a case: rows are curves over N, columns are N; a cell holds its replicates and what went wrong.
pub(super) fn cells(results: &Results) -> Markup {
    let cases = distinct(results.cells.iter().map(|c| c.series.case.as_str()));
    let count = |status: fn(Status) -> bool| results.cells.iter().filter(|c| status(Status::of(c))).count();
    let failed = count(|s| matches!(s, Status::Failures(_)));
    let imprecise = count(|s| s == Status::Imprecise);
    html! {
        p {
            (results.cells.len()) " cells. A cell holds its replicates; "
            @match failed { 0 => "every replicate gave an estimate", _ => { (failed) " cells have replicates without an estimate, which stand behind the minus sign" } }
            @if imprecise > 0 { "; " (imprecise) " cells are not as precise as the scenario asks (≈)" }
            "."
        }
        @for case in cases { (grid(case, &results.cells.iter().filter(|c| c.series.case == case).collect::<Vec<_>>())) }
    }
}

fn grid(case: &str, cells: &[&Cell]) -> Markup {
    let mut samples: Vec<usize> = cells.iter().map(|c| c.samples).collect();
    samples.sort_unstable();
    samples.dedup();
    let mut curves: Vec<(&Series, BTreeMap<usize, &Cell>)> = Vec::new();
    for cell in cells {
        match curves.iter_mut().find(|(series, _)| **series == cell.series) {
            Some((_, row)) => _ = row.insert(cell.samples, cell),
            None => curves.push((&cell.series, BTreeMap::from([(cell.samples, *cell)]))),
        }
    }
    let label = format!("Cells of {case}");
    html! {
        div class="scroll" tabindex="0" role="region" aria-label=(label) {
            table class="grid" {
                caption { (case) }
                thead { tr {
                    th scope="col" { "border" } th scope="col" { "method" } th scope="col" { "m" } th scope="col" { "noise" }
                    @for n in &samples { th scope="col" { "N = " (n) } }
                } }
                tbody {
                    @for (series, row) in &curves {
                        tr {
                            td { (series.border) } td { (series.method) } td { (series.points) } td { (series.noise) }
                            @for n in &samples {
                                @if let Some(cell) = row.get(n) {
                                    @let status = Status::of(cell);
                                    td class=(status.class()) { (status.reported(cell.replicates)) }
                                } @else { td { "–" } }
                            }
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
    use switchback_study::results::synthetic;

    #[test]
    fn every_cell_stands_in_the_grid_with_what_became_of_it() {
        let mut results = synthetic::results();
        results.cells.iter_mut().for_each(|cell| cell.failures.count = 0);
        results.cells[3].failures.count = 7;
        results.cells[4].precise = Some(false);
        let html = cells(&results).into_string();
        let entries = ["class=\"ok\"", "class=\"some\"", "class=\"no\""].map(|c| html.matches(c).count());
        let curves = results.series().len();
        assert_eq!(html.matches("<tr>").count(), curves + 1, "a row a curve, and the head");
        assert_eq!(entries.iter().sum::<usize>(), results.cells.len());
        assert_eq!(entries[1..], [1, 1]);
        assert!(html.contains("− 7") && html.contains("1 cells have replicates"));
    }
}
