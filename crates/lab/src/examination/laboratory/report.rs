//! The report's tables as CSV, and everything in one results.json.

pub mod json;
mod tables;

use super::case::Case;
use super::scenario::Study;
use super::score::Scores;
use crate::examination::measures_table;
use std::fmt::Write;
use switchback_io::output::Artefacts;

/// The files of the report but the key and the figures.
pub fn artefacts(study: &Study, key_sha256: &str, cases: &[Case], scores: &Scores) -> Artefacts {
    let mut artefacts = Artefacts::default();
    artefacts.add("results.json", json::results(study, key_sha256, cases, scores));
    artefacts.add("summary.txt", summary(scores));
    artefacts.add("answers.csv", tables::answers(cases));
    artefacts.add("confusion.csv", scores.confusion.csv());
    artefacts.add("accuracy.csv", tables::accuracy(&scores.accuracy));
    artefacts.add("calibration.csv", tables::calibration(&scores.calibration));
    artefacts.add("abstention.csv", tables::abstention(&scores.abstention));
    artefacts.add("closure.csv", tables::closure(&scores.closure));
    artefacts.add("where.csv", tables::places(&scores.places));
    artefacts.add("baselines.csv", tables::baselines(&scores.baselines));
    artefacts
}

/// The answers alone: what a part of an examination shows before the others are judged.
pub(super) fn answers(cases: &[Case]) -> String {
    tables::answers(cases)
}

/// The table of measures and that of simpler rules, as printed.
pub(crate) fn summary(scores: &Scores) -> String {
    let mut text = measures_table(&scores.measures);
    let _ = writeln!(
        text,
        "\n{:24} {:>13} {:>12} {:>14} {:>10}",
        "rules on the same rigs", "exact, ≥ 1 sd", "false alarm", "outside named", "precision"
    );
    for row in &scores.baselines {
        let shares = [row.exact, row.false_alarm, row.outside_named, row.precision];
        let [exact, alarm, outside, precision] =
            shares.map(|s| s.value().map_or_else(|| "—".to_owned(), |x| format!("{:.1} %", 100.0 * x)));
        let _ = writeln!(text, "{:24} {exact:>13} {alarm:>12} {outside:>14} {precision:>10}", row.rule);
    }
    text.push_str("The rules name one effect: precision is that over rigs with one or none.\n");
    text
}
