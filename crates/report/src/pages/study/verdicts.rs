//! The verdicts, and the comparisons on the same noise, as tables to sort.

use crate::pages::table::{Cell, Table};
use crate::study::paired;
use crate::study::row::rows;
use crate::study::table::cells;
use maud::{Markup, html};
use switchback_study::results::Results;

/// A row a case, method and group of parameters: slopes, coverage, efficiency, verdict.
pub(super) fn verdicts(results: &Results) -> Markup {
    let head = [
        "case",
        "method",
        "of",
        "sd slope",
        "… by theory",
        "bias slope",
        "that by theory",
        "coverage",
        "sd / theory",
        "variance / bound",
        "verdict",
    ];
    let mut table = Table::new("Verdicts by case, method and group of parameters", head);
    for row in rows(results) {
        let texts = cells(&row);
        let [method, of, sd_slope, bias_slope, coverage, theory, bound, verdict] = &texts[..] else {
            continue;
        };
        let number = |text: &String, value: Option<f64>| Cell::number(text.clone(), value);
        let by_theory = |slope: Option<f64>, decimals: usize| {
            Cell::number(slope.map_or_else(|| "–".to_owned(), |s| format!("{s:.decimals$}")), slope)
        };
        table.row([
            Cell::word(row.case),
            Cell::word(method.clone()),
            Cell::word(of.clone()),
            number(sd_slope, row.slope(|s| s.sd_slope).map(|f| f.estimate)),
            by_theory(row.median(|s| s.sd_slope_theory), 3),
            number(bias_slope, row.slope(|s| s.bias_slope).map(|f| f.estimate)),
            by_theory(row.median(|s| s.bias_slope_theory), 2),
            number(coverage, row.median(|s| s.coverage.map(|c| c.value()))),
            number(theory, row.median(|s| s.sd_over_theory.map(|r| r.value()))),
            number(bound, row.median(|s| s.variance_over_bound.map(|r| r.value()))),
            Cell::word(verdict.clone()),
        ]);
    }
    html! {
        (table.without_constant().html())
        p class="note" {
            "A row: medians over its border shapes, m and noise levels; intervals are 95 %; coverage and ratios at the largest N. "
            "The standard deviation of a consistent estimate falls as N to the power −½ and its bias as N to the power −1 where N is large; "
            "what theory gives at the very N of the study falls with the slopes beside them. "
            "sd / theory: empirical standard deviation over that of theory. variance / bound: over the Cramér–Rao bound."
        }
    }
}

/// What methods and borders are to each other on the same noise.
pub(super) fn paired(results: &Results) -> Markup {
    let overall = results.paired.as_ref().map_or(&[][..], |pairing| &pairing.overall);
    let Some(first) = overall.first() else { return html! {} };
    let head = [
        "case",
        "what over what",
        "variance ratio",
        "if run apart",
        "with control variates",
        "squared error",
    ];
    let mut table = Table::new(format!("Ratios on the same noise at N = {}", first.samples), head);
    for one in overall {
        let [what, ratio, apart, controlled, squared] = paired::row(one);
        table.row([
            Cell::word(one.case.clone()),
            Cell::word(what),
            Cell::number(ratio, Some(one.variance_ratio.value())),
            Cell::number(apart, Some(one.variance_ratio.unpaired_mcse())),
            Cell::number(controlled, one.variance_ratio_controlled.map(|r| r.value())),
            Cell::number(squared, Some(one.mse_ratio.value())),
        ]);
    }
    html! {
        p { "Both sides of a ratio see the same noise, so that what it does to both cancels. A variance ratio below 1 says that the first scatters less; only the ratio of squared errors counts the bias, too." }
        (table.without_constant().html())
    }
}
