//! A report: its tables, everything in one results.json, what is printed.

use super::answers::answers;
use super::case::Case;
use super::design::Design;
use super::field::bins;
use super::measure::{Measure, measures_table};
use super::part::case_lines;
use super::results::{Partial, Results, failed, not_observable};
use super::scenario::Study;
use super::scores::Scores;
use super::table::{Cell, Row, Table};
use std::fmt::Write;
use switchback_io::output::{Artefacts, markdown, markdown_text};

/// A report, and whether it is what the scenario expects.
#[derive(Debug, Clone)]
pub struct Report {
    /// All its files but the key.
    pub files: Artefacts,
    /// What is printed.
    pub summary: String,
    /// Whether every expectation of the scenario is met.
    pub is_as_expected: bool,
}

impl Report {
    /// The report without its figures.
    pub(crate) fn of(study: &Study, key_sha256: &str, cases: &[Case], scores: &Scores) -> Self {
        let mut files = Artefacts::default();
        files.add("results.json", Results::of(study, key_sha256, cases, scores).text());
        files.add("answers.csv", answers(study.design, cases));
        files.add("confusion.csv", scores.confusion.csv());
        let summary = match study.design {
            Design::Laboratory => {
                laboratory(&mut files, scores);
                let summary = rules(scores);
                files.add("summary.txt", summary.as_str());
                summary
            }
            Design::Field => {
                field(&mut files, scores);
                files.add("cases.jsonl", case_lines(cases));
                files.add("summary.md", page(study, cases, scores));
                let lines = notes(cases, scores).iter().fold(String::new(), |text, note| text + note + "\n");
                format!("{}\n{lines}", measures_table(&scores.measures))
            }
        };
        Self { files, summary, is_as_expected: !scores.measures.iter().any(Measure::is_unexpected) }
    }

    /// The same report where not all rigs are judged: each of its texts says so, and so does results.json.
    #[must_use]
    pub fn of_part(self, partial: Partial) -> Self {
        let mut files = Artefacts::default();
        for (name, contents) in self.files.iter() {
            match name.rsplit_once('.') {
                Some((_, "json")) => files.add(name, with_partial(contents, partial)),
                Some((_, "txt" | "md")) => {
                    files.add(name, format!("{partial}\n\n{}", String::from_utf8_lossy(contents)));
                }
                // A page is drawn of the other files.
                Some((_, "html")) => {}
                _ => files.add(name, contents),
            }
        }
        Self { files, summary: format!("{partial}\n\n{}", self.summary), ..self }
    }
}

/// A JSON object with the field `partial`.
fn with_partial(object: &[u8], partial: Partial) -> String {
    let mut value: serde_json::Value = serde_json::from_slice(object).expect("the program wrote it");
    value["partial"] = serde_json::to_value(partial).expect("numbers are JSON");
    format!("{value:#}\n")
}

fn laboratory(files: &mut Artefacts, scores: &Scores) {
    let same = |names: &[&'static str]| names.iter().map(|name| (*name, *name)).collect::<Vec<_>>();
    let bins = Table::of(
        &scores.claims.bins,
        &[
            ("claimed", |bin| Cell::Figure(bin.claimed)),
            ("held", |bin| Cell::Share(bin.held)),
            ("rigs", |bin| Cell::Count(bin.held.of)),
        ],
    );
    files.add("calibration.csv", bins.csv(&same(&["claimed", "held", "rigs"])));
    // A model that knows the effect closes all of the gap.
    let closure = scores.tables["closure"].with("oracle", |_| Cell::Count(1));
    let head = ["effect", "rigs", "stated", "actual", "oracle", "coverage", "error"];
    files.add("closure.csv", closure.csv(&same(&head)));
    let tables: [(_, &[&str]); 4] = [
        (
            "accuracy",
            &["effect", "wanted", "plain", "reached", "rigs", "exact", "class", "none", "unexplained"],
        ),
        ("abstention", &["threshold", "answered", "right", "rigs"]),
        ("where", &["axis", "precision", "recall", "f1", "cells"]),
        ("baselines", &["rule", "exact", "false_alarm", "outside_named", "precision"]),
    ];
    for (name, columns) in tables {
        files.add(format!("{name}.csv"), scores.tables[name].csv(&same(columns)));
    }
}

/// The table of measures and that of simpler rules, as printed.
fn rules(scores: &Scores) -> String {
    let mut text = measures_table(&scores.measures);
    let _ = writeln!(
        text,
        "\n{:24} {:>13} {:>12} {:>14} {:>10}",
        "rules on the same rigs", "exact, ≥ 1 sd", "false alarm", "outside named", "precision"
    );
    for row in &scores.tables["baselines"].rows {
        let shares = ["exact", "false_alarm", "outside_named", "precision"];
        let [exact, alarm, outside, precision] = shares.map(|name| percent(row, name, 1));
        let rule = word(row, "rule");
        let _ = writeln!(text, "{rule:24} {exact:>13} {alarm:>12} {outside:>14} {precision:>10}");
    }
    text.push_str("The rules name one effect: precision is that over rigs with one or none.\n");
    text
}

fn percent(row: &Row, name: &str, decimals: usize) -> String {
    let share = Table::share(row, name).value();
    share.map_or_else(|| "—".to_owned(), |x| format!("{:.decimals$} %", 100.0 * x))
}

fn word<'r>(row: &'r Row, name: &str) -> &'r str {
    if let Some(Cell::Word(word)) = row.get(name) { word } else { "" }
}

/// The tables of answers in the field: title, what a row is of, name and file.
const ANSWERS: [(&str, &str, &str, &str); 4] = [
    ("By the size reached", "size", "by_size", "by-size.csv"),
    ("By how the fault was put in, size ≥ 2", "planting", "by_planting", "by-planting.csv"),
    ("By effect, size ≥ 2", "effect", "by_effect", "by-effect.csv"),
    ("By base, size ≥ 2", "base", "by_base", "by-base.csv"),
];

fn field(files: &mut Artefacts, scores: &Scores) {
    for (_, of, name, file) in ANSWERS {
        let table = scores.tables[name].with("judged", |row| Cell::Count(Table::share(row, "exact").of));
        let same = ["with_model", "answers", "judged", "exact", "class", "silent", "wrong"];
        let columns: Vec<_> = [(of, "of")].into_iter().chain(same.map(|name| (name, name))).collect();
        files.add(file, table.csv(&columns));
    }
    let columns = ["stratum", "with_model", "claimed", "held", "answers"].map(|name| (name, name));
    files.add("calibration.csv", bins(&scores.claims, &scores.strata).csv(&columns));
}

/// What is printed of the field, with the tables, as Markdown.
fn page(study: &Study, cases: &[Case], scores: &Scores) -> String {
    let mut text = format!("# {}\n\n{}\n\n", markdown(&study.name), markdown_text(&study.question));
    let _ = writeln!(text, "```text\n{}```\n", measures_table(&scores.measures));
    for note in notes(cases, scores) {
        let _ = writeln!(text, "- {note}");
    }
    for (title, of, name, _) in ANSWERS {
        let _ = writeln!(text, "\n## {title}\n");
        let _ = writeln!(text, "| {of} | model | answers | exact | right class | silent | wrong |");
        text.push_str("|---|---|---:|---:|---:|---:|---:|\n");
        for row in &scores.tables[name].rows {
            let shares = ["exact", "class", "silent", "wrong"].map(|name| percent(row, name, 0)).join(" | ");
            let (of, model) = (markdown(word(row, "of")), model(row["with_model"] == Cell::Flag(true)));
            let answers = row["answers"].number().unwrap_or(0.0);
            let _ = writeln!(text, "| {of} | {model} | {answers} | {shares} |");
        }
    }
    text.push_str("\n## Calibration by stratum, the worst first\n\n");
    text.push_str(
        "| stratum | model | claims | error | of perfect claims | excess |\n|---|---|---:|---:|---:|---:|\n",
    );
    for stratum in &scores.strata {
        let figure = |x: Option<f64>| x.map_or_else(|| "—".to_owned(), |x| format!("{x:.3}"));
        let (of, claims) = (markdown(&stratum.of), &stratum.claims);
        let figures = [claims.error, claims.perfect, claims.excess].map(figure).join(" | ");
        let _ = writeln!(text, "| {of} | {} | {} | {figures} |", model(stratum.with_model), claims.count);
    }
    text
}

/// What a reader must know of the measures in the field.
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
    let refused = cases.iter().filter(|case| case.refused.is_some()).count();
    let counted = [
        (not_observable(cases), "Not observable (size below ½) and not counted", "faults"),
        (refused, "Could not be made, results.json says why", "rigs"),
        (failed(cases), "Refused, and counted as silent", "diagnoses"),
    ];
    let counted = counted.into_iter().filter(|(count, ..)| *count > 0);
    notes.extend(counted.map(|(count, what, of)| format!("{what}: {count} {of}.")));
    if let Some(worst) = scores.strata.first() {
        let (of, model, claims) = (&worst.of, model(worst.with_model), &worst.claims);
        notes.push(format!(
            "Worst stratum of the calibration: {of}, model {model}: {:.3} over perfect claims ({} claims).",
            claims.excess.unwrap_or(0.0),
            claims.count
        ));
    }
    notes
}

fn model(given: bool) -> &'static str {
    if given { "given" } else { "not given" }
}
