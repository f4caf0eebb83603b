//! What a study cannot say.

use crate::pages::table::{Cell, Table};
use maud::{Markup, html};
use switchback_study::results::{Results, Verdict};

/// Verdicts that are open, biases below what the replicates resolve, replicates without an estimate.
pub(super) fn unresolved(results: &Results) -> Markup {
    let mut open = Table::new("Curves without a verdict", ["curve", "of", "why"]);
    for summary in results.summaries.iter().filter(|s| s.verdict == Verdict::Undecided) {
        let of = summary.group.label();
        open.row([
            Cell::word(summary.series.to_string()),
            Cell::word(of),
            Cell::word(summary.reason.clone()),
        ]);
    }
    let all = results.summaries.len();
    let hidden = results.summaries.iter().filter(|s| s.bias_slope.is_none() && s.plateau.is_none()).count();
    let mut failed =
        Table::new("Replicates without an estimate", ["cell", "curve", "N", "replicates", "of", "reason"]);
    for (number, cell) in results.cells.iter().enumerate().filter(|(_, c)| c.failures.count > 0) {
        failed.row([
            Cell::number(number.to_string(), Some(number as f64)),
            Cell::word(cell.series.to_string()),
            Cell::number(cell.samples.to_string(), Some(cell.samples as f64)),
            Cell::number(cell.failures.count.to_string(), Some(cell.failures.count as f64)),
            Cell::number(cell.replicates.to_string(), Some(cell.replicates as f64)),
            Cell::word(cell.failures.reason.clone().unwrap_or_default()),
        ]);
    }
    let is_failing = results.cells.iter().any(|c| c.failures.count > 0);
    html! {
        ul {
            @match results.summaries.iter().filter(|s| s.verdict == Verdict::Undecided).count() {
                0 => li { "Every one of " (all) " curves has a verdict." },
                count => li { (count) " of " (all) " curves have no verdict." },
            }
            @if hidden > 0 { li { "On " (hidden) " of " (all) " curves the bias is below what the replicates resolve, so that it has no slope." } }
            @if !is_failing { li { "Every replicate gave an estimate." } }
            li { "A verdict holds for the range of N, the noise levels and the borders of this design, and says nothing beyond them." }
        }
        (open.html())
        (failed.html())
        @if is_failing { p class="note" { code { "switchback replay RESULTS CELL:REPLICATE" } " runs one of them again alone." } }
    }
}
