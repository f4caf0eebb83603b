//! Tables of an examination's page.

use crate::pages::table::{Cell, Table};
use maud::{Markup, html};
use switchback_lab::examination::{self, Refused, Results, Row, Share};

/// A table of results.json: its name there, its caption, and heads with the columns below them.
pub(super) type Shown = (&'static str, &'static str, &'static [(&'static str, &'static str)]);

pub(super) const SIZES: Shown = (
    "sizes",
    "Answers by the size of the surviving gap, in standard deviations of the noise",
    &[
        ("size", "size"),
        ("exact", "exact"),
        ("right class", "class"),
        ("class under law mismatch", "mismatch_class"),
        ("wrong", "wrong"),
    ],
);

pub(super) const CLOSURE: Shown = (
    "closure",
    "Closure by effect: what the diagnosis states, and what is true",
    &[
        ("effect", "effect"),
        ("rigs", "rigs"),
        ("stated", "stated"),
        ("actual", "actual"),
        ("90 % intervals that hold it", "coverage"),
        ("mean error", "error"),
    ],
);

pub(super) const PLACES: Shown = (
    "where",
    "Cells of the map that are flagged, against those where the effect is",
    &[("axis", "axis"), ("precision", "precision"), ("recall", "recall"), ("F1", "f1"), ("cells", "cells")],
);

pub(super) const RULES: Shown = (
    "baselines",
    "Rules on the same rigs",
    &[
        ("rule", "rule"),
        ("exact, size ≥ 1 sd", "exact"),
        ("false alarm", "false_alarm"),
        ("effect outside the library named", "outside_named"),
        ("precision", "precision"),
    ],
);

/// Tables of answers in the field: name, caption, what a row is of.
const ANSWERS: [(&str, &str, &str); 4] = [
    ("by_size", "By the size reached", "size"),
    ("by_planting", "By how the fault was put in, size ≥ 2", "planting"),
    ("by_effect", "By effect, size ≥ 2", "effect"),
    ("by_base", "By base, size ≥ 2", "base"),
];

pub(super) fn shown(results: &Results, (name, caption, columns): Shown) -> Markup {
    let heads: Vec<&str> = columns.iter().map(|(head, _)| *head).collect();
    let columns: Vec<&str> = columns.iter().map(|(_, column)| *column).collect();
    table(results, (name, caption), &heads, &columns)
}

pub(super) fn answers(results: &Results) -> Markup {
    let columns = ["of", "with_model", "answers", "exact", "class", "silent", "wrong"];
    let heads = |of| [of, "model", "answers", "exact", "right class", "silent", "wrong"];
    html! { @for (name, caption, of) in ANSWERS { (table(results, (name, caption), &heads(of), &columns)) } }
}

fn table(results: &Results, (name, caption): (&str, &str), heads: &[&str], columns: &[&str]) -> Markup {
    let mut table = Table::of(caption, heads);
    for row in results.tables.get(name).map_or(&[][..], |table| &table.rows) {
        table.row(columns.iter().map(|column| cell(row, column)).collect::<Vec<_>>());
    }
    table.html()
}

/// Closures are reported in percent.
fn cell(row: &Row, column: &str) -> Cell {
    match row.get(column) {
        Some(examination::Cell::Word(word)) => Cell::word(word.replace('_', " ")),
        Some(examination::Cell::Flag(given)) => Cell::word(model(*given)),
        Some(examination::Cell::Share(one)) => share(*one),
        Some(examination::Cell::Count(count)) => Cell::number(count.to_string(), Some(*count as f64)),
        Some(examination::Cell::Given(x) | examination::Cell::Figure(x)) => {
            let reported = match column {
                "size" => x.to_string(),
                "stated" | "actual" | "error" => format!("{:.1} %", 100.0 * x),
                _ => format!("{x:.3}"),
            };
            Cell::number(reported, Some(*x))
        }
        None => Cell::number("–", None),
    }
}

/// `96.0 % (145 of 151)`.
fn share(share: Share) -> Cell {
    match share.value() {
        Some(value) => {
            Cell::number(format!("{:.1} % ({} of {})", 100.0 * value, share.count, share.of), Some(value))
        }
        None => Cell::number("–", None),
    }
}

fn model(given: bool) -> &'static str {
    if given { "given" } else { "not given" }
}

pub(super) fn strata(results: &Results) -> Markup {
    let heads = ["stratum", "model", "claims", "error", "of perfect claims", "excess"];
    let mut table = Table::new("Calibration by stratum, the worst first", heads);
    for stratum in results.strata.iter().flatten() {
        let figure =
            |x: Option<f64>| Cell::number(x.map_or_else(|| "–".to_owned(), |x| format!("{x:.3}")), x);
        let claims = &stratum.claims;
        table.row([
            Cell::word(stratum.of.replace('_', " ")),
            Cell::word(model(stratum.with_model)),
            Cell::number(claims.count.to_string(), Some(claims.count as f64)),
            figure(claims.error),
            figure(claims.perfect),
            figure(claims.excess),
        ]);
    }
    table.html()
}

pub(super) fn refused(results: &Results) -> Markup {
    let mut table = Table::new("Rigs that could not be made", ["rig", "why"]);
    for one in &results.refused {
        if let Refused::Reported { id, why } = one {
            table.row([Cell::number(id.to_string(), Some(*id as f64)), Cell::word(why.clone())]);
        }
    }
    table.html()
}
