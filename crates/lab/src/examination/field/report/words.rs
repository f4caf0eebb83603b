//! What is printed, and the page for the reader.

use crate::examination::measures_table;
use crate::field::case::Case;
use crate::field::scenario::Study;
use crate::field::score::{AnswerRow, Scores};
use std::fmt::Write;
use switchback_io::output::{markdown, markdown_text};

/// The measures and what a reader must know of them.
pub(super) fn printed(cases: &[Case], scores: &Scores) -> String {
    let mut text = measures_table(&scores.measures);
    text.push('\n');
    for note in notes(cases, scores) {
        let _ = writeln!(text, "{note}");
    }
    text
}

/// The same with the tables, as Markdown.
pub(super) fn page(study: &Study, cases: &[Case], scores: &Scores) -> String {
    let mut text = format!("# {}\n\n{}\n\n", markdown(&study.name), markdown_text(&study.question));
    let _ = writeln!(text, "```text\n{}```\n", measures_table(&scores.measures));
    for note in notes(cases, scores) {
        let _ = writeln!(text, "- {note}");
    }
    let tables = [
        ("By the size reached", "size", &scores.by_size),
        ("By how the fault was put in, size ≥ 2", "planting", &scores.by_planting),
        ("By effect, size ≥ 2", "effect", &scores.by_effect),
        ("By base, size ≥ 2", "base", &scores.by_base),
    ];
    for (title, of, rows) in tables {
        let _ = writeln!(text, "\n## {title}\n");
        table(&mut text, of, rows);
    }
    text.push_str("\n## Calibration by stratum, the worst first\n\n");
    text.push_str(
        "| stratum | model | claims | error | of perfect claims | excess |\n|---|---|---:|---:|---:|---:|\n",
    );
    for stratum in &scores.strata {
        let figure = |x: Option<f64>| x.map_or_else(|| "—".to_owned(), |x| format!("{x:.3}"));
        let (claims, model) = (&stratum.claims, model(stratum.with_model));
        let [error, perfect, excess] = [claims.error, claims.perfect, claims.excess()].map(figure);
        let _ = writeln!(
            text,
            "| {} | {model} | {} | {error} | {perfect} | {excess} |",
            markdown(&stratum.of),
            claims.count
        );
    }
    text
}

fn notes(cases: &[Case], scores: &Scores) -> Vec<String> {
    let mut notes = Vec::new();
    if cases.iter().all(|case| !case.is_measured) {
        notes.push("NO MEASURED BASE is among these rigs: all figures are of made bases.".to_owned());
    }
    notes.push(
        "Every rig is diagnosed twice, and judged by what is named beyond what its base shows by itself; silence about a fault \
         counts as missed."
            .to_owned(),
    );
    if scores.not_observable > 0 {
        notes.push(format!(
            "Not observable (size below ½) and not counted: {} faults.",
            scores.not_observable
        ));
    }
    if !scores.refused.is_empty() {
        notes.push(format!("Could not be made, results.json says why: {} rigs.", scores.refused.len()));
    }
    if scores.failed > 0 {
        notes.push(format!("Refused, and counted as silent: {} diagnoses.", scores.failed));
    }
    if let Some(worst) = scores.strata.first() {
        let excess = worst.claims.excess().unwrap_or(0.0);
        let (of, model) = (&worst.of, model(worst.with_model));
        notes.push(format!(
            "Worst stratum of the calibration: {of}, model {model}: {excess:.3} over perfect claims ({} claims).",
            worst.claims.count
        ));
    }
    notes
}

fn model(given: bool) -> &'static str {
    if given { "given" } else { "not given" }
}

fn table(text: &mut String, of: &str, rows: &[AnswerRow]) {
    let _ = writeln!(text, "| {of} | model | answers | exact | right class | silent | wrong |");
    text.push_str("|---|---|---:|---:|---:|---:|---:|\n");
    for row in rows {
        let percent = [row.exact, row.class, row.silent, row.wrong]
            .map(|share| share.value().map_or_else(|| "—".to_owned(), |x| format!("{:.0} %", 100.0 * x)));
        let [exact, class, silent, wrong] = percent;
        let (of, model, answers) = (markdown(&row.of), model(row.with_model), row.asked);
        let _ = writeln!(text, "| {of} | {model} | {answers} | {exact} | {class} | {silent} | {wrong} |");
    }
}
