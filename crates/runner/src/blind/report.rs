//! The report: tables as CSV, figures as SVG, everything in one results.json.

mod json;
mod tables;

use super::case::Case;
use super::scenario::Study;
use super::score::{Bound, Measure, Scores};
use crate::output::Artefacts;
use crate::plots::blind as plots;
use std::fmt::Write;

/// All files of the report but the key.
///
/// # Errors
/// A figure that could not be drawn.
pub fn artefacts(
    study: &Study,
    key_sha256: &str,
    cases: &[Case],
    scores: &Scores,
) -> miette::Result<Artefacts> {
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
    artefacts.add("confusion.svg", plots::confusion(&scores.confusion)?);
    artefacts.add("accuracy.svg", plots::accuracy(&scores.sizes)?);
    artefacts.add("calibration.svg", plots::calibration(&scores.calibration)?);
    artefacts.add("abstention.svg", plots::abstention(&scores.abstention)?);
    artefacts.add("closure.svg", plots::closure(cases)?);
    artefacts.add("baselines.svg", plots::baselines(&scores.baselines)?);
    Ok(artefacts)
}

/// The table of measures, as printed: measure, what must be reached, what was, how many rigs tell.
pub fn summary(scores: &Scores) -> String {
    let mut text = format!("{:46} {:>12}  {:>9}  {:>7}\n", "measure", "must reach", "reached", "rigs");
    for measure in &scores.measures {
        let reached = measure.reached.map_or_else(|| "—".to_owned(), |x| figure(measure.target, x));
        let mark = match measure.meets_target() {
            Some(true) => "",
            Some(false) => "  short",
            None => "  not told",
        };
        let _ = writeln!(
            text,
            "{:46} {:>12}  {reached:>9}  {:>7}{mark}{}",
            measure.text,
            measure.target.map_or_else(String::new, told),
            measure.rigs,
            unexpected(measure),
        );
    }
    text.push_str("\nthe same rigs, simpler rules                   exact ≥ 1 sd   false alarm   outside named   precision\n");
    for row in &scores.baselines {
        let share = |s: super::score::Share| {
            s.value().map_or_else(|| "—".to_owned(), |x| format!("{:.1} %", 100.0 * x))
        };
        let _ = writeln!(
            text,
            "{:46} {:>12} {:>13} {:>15} {:>11}",
            row.rule,
            share(row.exact),
            share(row.false_alarm),
            share(row.outside_named),
            share(row.precision),
        );
    }
    text
}

fn unexpected(measure: &Measure) -> String {
    match measure.expected.filter(|_| measure.is_unexpected()) {
        Some(bound) => format!("  UNEXPECTED: the scenario wants {}", told(bound)),
        None => String::new(),
    }
}

/// Shares in percent, errors as they are.
fn figure(bound: Option<Bound>, x: f64) -> String {
    match bound {
        Some(Bound::AtMost(limit)) if limit <= 0.05 && x < 0.1 => format!("{x:.4}"),
        _ => format!("{:.1} %", 100.0 * x),
    }
}

fn told(bound: Bound) -> String {
    match bound {
        Bound::AtLeast(x) => format!("≥ {}", figure(None, x)),
        Bound::AtMost(x) => format!("≤ {x}"),
        Bound::Within(low, high) => format!("{:.0}–{:.0} %", 100.0 * low, 100.0 * high),
    }
}
