//! The sections of a blind examination.

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
use switchback_lab::blind::json::BlindFile;

/// Figures that have a section of their own.
const PLACED: [&str; 6] = ["accuracy", "abstention", "baselines", "calibration", "closure", "confusion"];

pub(super) fn blind(files: &Files, results: &BlindFile) -> Result<String, PageError> {
    let figure = |name: &str| sheets(files.figures(name));
    let lead = html! {
        p class="lead" { (results.question) }
        div class="box" { (partial(results.partial)) (measures::answer(&results.measures)) }
    };
    let made = Made {
        study: &results.study,
        version: &results.version,
        seed: results.seed,
        rigs: &results.rigs,
        key: &results.key_sha256,
        design: &results.design,
    };
    Ok(Page::new("Blind examination of the diagnosis", &results.name, lead)
        .section("measures", "What was reached", measures::table(&results.measures))
        .section("confusion", "What was named", figure("confusion")?)
        .section("sizes", "By the size of the effect", html! { (figure("accuracy")?) (sizes(results)) })
        .section(
            "calibration",
            "What the probabilities are worth",
            html! { (figure("calibration")?) (figure("abstention")?) },
        )
        .section("closure", "How far gaps close", html! { (figure("closure")?) (closure(results)) })
        .section("where", "Whether places are found", places(results))
        .section("rules", "Other rules on the same rigs", html! { (figure("baselines")?) (rules(results)) })
        .section("figures", "Other figures", sheets(files.other_figures(&PLACED))?)
        .section("unresolved", "What it cannot say", unresolved(results))
        .section("made", "How it was made", made.html())
        .html())
}

fn sizes(results: &BlindFile) -> Markup {
    let mut table = Table::new(
        "Answers by the size of the surviving gap, in standard deviations of the noise",
        ["size", "exact", "right class", "class under law mismatch", "wrong"],
    );
    for size in &results.sizes {
        let wanted = Cell::number(size.size.to_string(), Some(size.size));
        table.row([
            wanted,
            share(size.exact),
            share(size.class),
            share(size.mismatch_class),
            share(size.wrong),
        ]);
    }
    table.html()
}

fn closure(results: &BlindFile) -> Markup {
    let mut table = Table::new(
        "Closure by effect: what the diagnosis states, and what is true",
        ["effect", "rigs", "stated", "actual", "90 % intervals that hold it", "mean error"],
    );
    for row in &results.closure {
        let percent = |x: f64| Cell::number(format!("{:.1} %", 100.0 * x), Some(x));
        let rigs = Cell::number(row.rigs.to_string(), Some(row.rigs as f64));
        table.row([
            Cell::word(row.effect.replace('_', " ")),
            rigs,
            percent(row.stated),
            percent(row.actual),
            share(row.coverage),
            percent(row.error),
        ]);
    }
    table.html()
}

fn places(results: &BlindFile) -> Markup {
    let mut table = Table::new(
        "Cells of the map that are flagged, against those where the effect is",
        ["axis", "precision", "recall", "F1", "cells"],
    );
    for place in &results.r#where {
        let figure = |x: f64| Cell::number(format!("{x:.3}"), Some(x));
        let cells = Cell::number(place.cells.to_string(), Some(place.cells as f64));
        table.row([
            Cell::word(place.axis.replace('_', " ")),
            figure(place.precision),
            figure(place.recall),
            figure(place.f1),
            cells,
        ]);
    }
    table.html()
}

fn rules(results: &BlindFile) -> Markup {
    let mut table = Table::new(
        "Rules on the same rigs",
        ["rule", "exact, size ≥ 1 sd", "false alarm", "effect outside the library named", "precision"],
    );
    for rule in &results.baselines {
        table.row([
            Cell::word(rule.rule.clone()),
            share(rule.exact),
            share(rule.false_alarm),
            share(rule.outside_named),
            share(rule.precision),
        ]);
    }
    table.html()
}

fn unresolved(results: &BlindFile) -> Markup {
    html! {
        ul {
            @if results.refused.is_empty() { li { "Every rig could be diagnosed." } }
            @else { li { (results.refused.len()) " rigs could not be diagnosed, and count as not named: " (results.refused.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")) "." } }
            li { "Rigs are made by the program's own maker; a figure holds for rigs drawn like these." }
        }
    }
}
