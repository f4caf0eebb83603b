//! The sections of a field examination.

use super::made::Made;
use super::measures;
use super::partial::partial;
use super::share::share;
use crate::pages::error::PageError;
use crate::pages::files::Files;
use crate::pages::layout::Page;
use crate::pages::sheet::sheets;
use crate::pages::table::{Cell, Table};
use maud::{Markup, html};
use switchback_lab::field::json::{Answers, FieldFile};

/// Figures that have a section of their own.
const PLACED: [&str; 2] = ["calibration", "confusion"];

pub(super) fn field(files: &Files, results: &FieldFile) -> Result<String, PageError> {
    let figure = |name: &str| sheets(files.figures(name));
    let lead = html! {
        p class="lead" { (results.question) }
        div class="box" {
            (partial(results.partial))
            (measures::answer(&results.measures))
            @if results.measured_bases.is_empty() { p class="bad" { "No measured base is among these rigs: all figures are of made bases." } }
        }
    };
    let made = Made {
        study: &results.study,
        version: &results.version,
        seed: results.seed,
        rigs: &results.rigs,
        key: &results.key_sha256,
        design: &results.design,
    };
    let tables = [
        ("By the size reached", "size", &results.by_size),
        ("By how the fault was put in, size ≥ 2", "planting", &results.by_planting),
        ("By effect, size ≥ 2", "effect", &results.by_effect),
        ("By base, size ≥ 2", "base", &results.by_base),
    ];
    Ok(Page::new("Field examination of the diagnosis", &results.name, lead)
        .section("measures", "What was reached", measures::table(&results.measures))
        .section(
            "answers",
            "Answers",
            html! { @for (caption, of, rows) in tables { (answers(caption, of, rows)) } },
        )
        .section("confusion", "What was named", figure("confusion")?)
        .section(
            "calibration",
            "What the probabilities are worth",
            html! { (figure("calibration")?) (strata(results)) },
        )
        .section("figures", "Other figures", sheets(files.other_figures(&PLACED))?)
        .section("unresolved", "What it cannot say", unresolved(results))
        .section("made", "How it was made", made.html())
        .html())
}

fn model(given: bool) -> &'static str {
    if given { "given" } else { "not given" }
}

fn answers(caption: &str, of: &str, rows: &[Answers]) -> Markup {
    let mut table = Table::new(caption, [of, "model", "answers", "exact", "right class", "silent", "wrong"]);
    for row in rows {
        let asked = Cell::number(row.answers.to_string(), Some(row.answers as f64));
        let shares = [row.exact, row.class, row.silent, row.wrong].map(share);
        let [exact, class, silent, wrong] = shares;
        table.row([
            Cell::word(row.of.replace('_', " ")),
            Cell::word(model(row.with_model)),
            asked,
            exact,
            class,
            silent,
            wrong,
        ]);
    }
    table.html()
}

fn strata(results: &FieldFile) -> Markup {
    let head = ["stratum", "model", "claims", "error", "of perfect claims", "excess"];
    let mut table = Table::new("Calibration by stratum, the worst first", head);
    for stratum in &results.strata {
        let figure =
            |x: Option<f64>| Cell::number(x.map_or_else(|| "–".to_owned(), |x| format!("{x:.3}")), x);
        let claims = &stratum.calibration;
        table.row([
            Cell::word(stratum.of.replace('_', " ")),
            Cell::word(model(stratum.with_model)),
            Cell::number(claims.claims.to_string(), Some(claims.claims as f64)),
            figure(claims.error),
            figure(claims.perfect),
            figure(claims.excess),
        ]);
    }
    table.html()
}

fn unresolved(results: &FieldFile) -> Markup {
    let mut refused = Table::new("Rigs that could not be made", ["rig", "why"]);
    for one in &results.refused {
        refused.row([Cell::number(one.id.to_string(), Some(one.id as f64)), Cell::word(one.why.clone())]);
    }
    html! {
        ul {
            li { "Every rig is diagnosed twice, with its model given and without, and judged by what is named beyond what its base shows by itself; silence about a fault counts as missed." }
            @if results.not_observable > 0 { li { (results.not_observable) " faults are not observable (size below ½), and not counted." } }
            @if results.failed > 0 { li { (results.failed) " diagnoses were refused, and count as silent." } }
            @if results.measured_bases.is_empty() { li { "No machine that was measured is among the bases." } }
            @else { li { "Measured bases: " (results.measured_bases.join(", ")) "." } }
        }
        (refused.html())
    }
}
