//! The report: tables, everything in one results.json, what is printed, figures.

pub mod json;
mod tables;
mod words;

use super::case::Case;
use super::scenario::Study;
use super::score::Scores;
use crate::examination::{Measure, Report, case_lines};
use switchback_io::output::Artefacts;

/// The table of answers: what a part of an examination shows before the others are judged.
pub(super) use tables::answers;

/// The report but for the key.
pub(super) fn report(
    study: &Study,
    key_sha256: &str,
    cases: &[Case],
    scores: &Scores,
) -> miette::Result<Report> {
    let mut files = Artefacts::default();
    files.add("results.json", json::results(study, key_sha256, cases, scores));
    files.add("summary.md", words::page(study, cases, scores));
    files.add("answers.csv", tables::answers(cases));
    files.add("cases.jsonl", case_lines(cases));
    files.add("by-effect.csv", tables::rows("effect", &scores.by_effect));
    files.add("by-base.csv", tables::rows("base", &scores.by_base));
    files.add("by-planting.csv", tables::rows("planting", &scores.by_planting));
    files.add("by-size.csv", tables::rows("size", &scores.by_size));
    files.add("confusion.csv", scores.confusion.csv());
    files.add("calibration.csv", tables::strata(scores));
    let is_as_expected = !scores.measures.iter().any(Measure::is_unexpected);
    Ok(Report { files, summary: words::printed(cases, scores), is_as_expected })
}
