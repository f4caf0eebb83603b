//! The report's tables as CSV, and everything in one results.json.

mod json;
mod tables;

use super::case::Case;
use super::scenario::Study;
use super::score::{Bound, Measure, Scores};
use crate::output::Artefacts;
use std::fmt::Write;

/// The files of the report but the key and the figures.
pub fn artefacts(study: &Study, key_sha256: &str, cases: &[Case], scores: &Scores) -> Artefacts {
    let mut artefacts = Artefacts::default();
    artefacts.add("results.json", json::results(study, key_sha256, cases, scores));
    artefacts.add("summary.txt", summary(scores));
    artefacts.add("answers.csv", tables::answers(cases));
    artefacts.add("confusion.csv", tables::confusion(&scores.confusion));
    artefacts.add("accuracy.csv", tables::accuracy(&scores.accuracy));
    artefacts.add("calibration.csv", tables::calibration(&scores.calibration));
    artefacts.add("abstention.csv", tables::abstention(&scores.abstention));
    artefacts.add("closure.csv", tables::closure(&scores.closure));
    artefacts.add("where.csv", tables::places(&scores.places));
    artefacts.add("baselines.csv", tables::baselines(&scores.baselines));
    artefacts
}

/// The answers alone: what a part of an examination tells before the others are judged.
pub(super) fn answers(cases: &[Case]) -> String {
    tables::answers(cases)
}

/// The table of measures, as printed: measure, what must be reached, what was and its 95 % interval, how many
/// rigs tell.
pub fn summary(scores: &Scores) -> String {
    let mut text = format!(
        "{:51} {:>11} {:>9} {:>15} {:>6}\n",
        "measure", "must reach", "reached", "95 % interval", "rigs"
    );
    for measure in &scores.measures {
        let reached = measure.reached.map_or_else(|| "—".to_owned(), |x| figure(measure, x));
        let mark = match (measure.reached, measure.meets_target()) {
            (None, _) => "  not told",
            (_, Some(false)) => "  short",
            _ => "",
        };
        let interval = measure
            .interval
            .map_or_else(String::new, |[low, high]| format!("{:.1}–{:.1} %", 100.0 * low, 100.0 * high));
        let target = measure.target.map_or_else(String::new, |bound| told(measure, bound));
        let (what, rigs, broken) = (measure.text, measure.rigs, unexpected(measure));
        let _ = writeln!(text, "{what:51} {target:>11} {reached:>9} {interval:>15} {rigs:>6}{mark}{broken}");
    }
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

fn unexpected(measure: &Measure) -> String {
    match measure.expected.filter(|_| measure.is_unexpected()) {
        Some(bound) => format!("  UNEXPECTED: the scenario wants {}", told(measure, bound)),
        None => String::new(),
    }
}

/// Shares in percent, everything else as it is.
fn figure(measure: &Measure, x: f64) -> String {
    match measure.key {
        "ece" | "closure_error" | "where_f1" => format!("{x:.3}"),
        _ => format!("{:.1} %", 100.0 * x),
    }
}

fn told(measure: &Measure, bound: Bound) -> String {
    match bound {
        Bound::AtLeast(x) => format!("≥ {}", figure(measure, x)),
        Bound::AtMost(x) => format!("≤ {}", figure(measure, x)),
        Bound::Within(low, high) => format!("{:.0}–{:.0} %", 100.0 * low, 100.0 * high),
    }
}
