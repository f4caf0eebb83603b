//! What is counted of pairs.

use super::Made;
use super::joint::Joint;
use switchback_diagnose::{Effect, Status, Verdict};
use switchback_io::diagnosis::{Report, ReportedDifference, Units};

/// What is counted of a kind.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Counted {
    pub(crate) pairs: usize,
    /// The expected rows come first; of pairs without a difference: none is shown.
    right: usize,
    /// Their true values that lie in the 95 % interval, of those right.
    covered: usize,
    valued: usize,
    /// Rows of what is the same, and those of them that are shown as the same.
    same: usize,
    shown_same: usize,
    /// Verdicts that name what is missing in the simulator, else that values are off, else that nothing is.
    answered: usize,
}

impl Counted {
    pub(crate) fn add(&mut self, other: Self) {
        self.pairs += other.pairs;
        self.right += other.right;
        self.covered += other.covered;
        self.valued += other.valued;
        self.same += other.same;
        self.shown_same += other.shown_same;
        self.answered += other.answered;
    }

    pub(crate) fn line(&self, name: &str) -> String {
        format!(
            "{name:<16} {:>5} {:>6} {:>8} {:>8}/{:<4} {:>8}/{:<5}",
            self.pairs, self.right, self.answered, self.covered, self.valued, self.shown_same, self.same
        )
    }
}

/// What is counted of one pair, and what is wrong with it.
pub(crate) fn compared(made: &Made, report: &Report, seed: u64) -> (Counted, Option<String>) {
    let rows = rows(report);
    let expected = |row: &ReportedDifference| {
        made.expected.iter().find(|(what, _)| *what == unnumbered(&row.what)).map(|(_, values)| *values)
    };
    let shown: Vec<&ReportedDifference> = rows.iter().filter(|row| row.differs).collect();
    let first = &shown[..shown.len().min(made.expected.len())];
    let is_named = |row: &&ReportedDifference| {
        expected(row).is_some() && (!made.is_joint || row.attribute == Joint::attribute(&row.what))
    };
    let found = if made.expected.is_empty() { shown.len() } else { made.expected.len() };
    let right = !rows.is_empty() && first.iter().filter(|row| is_named(row)).count() == found;
    let others = rows.iter().filter(|row| expected(row).is_none());
    let mut counted = Counted { pairs: 1, right: usize::from(right), ..Counted::default() };
    counted.same = others.clone().count();
    counted.shown_same = others.filter(|row| !row.differs).count();
    let mut errors = Vec::new();
    for (row, [simulator, machine]) in
        first.iter().filter(|_| right).filter_map(|row| Some((row, expected(row)?)))
    {
        let deviation = match row.what.as_str() {
            // Only the distance of two zeros or delays means anything.
            "offset" | "delay" => (row.in_b - row.in_a) - (machine - simulator),
            _ => row.in_b - machine,
        };
        counted.valued += 1;
        errors.push(deviation / row.se);
        counted.covered += usize::from(deviation.abs() <= 1.96 * row.se);
    }
    counted.answered = usize::from(is_answered(made, &report.diagnosis.verdict));
    let is_wrong = !right
        || counted.answered == 0
        || counted.covered < counted.valued
        || counted.shown_same < counted.same;
    let wrong = is_wrong.then(|| {
        let shown: Vec<String> = shown
            .iter()
            .map(|r| format!("{} {:.4e} → {:.4e} ± {:.1e}", r.what, r.in_a, r.in_b, r.se))
            .collect();
        format!(
            "{seed} {} {:?} {:?} off by {errors:.2?}: {}",
            made.kind,
            made.expected,
            report.diagnosis.verdict.status,
            shown.join(", ")
        )
    });
    (counted, wrong)
}

/// Whether a verdict answers the question of whose gap it is. A mass is no effect that a verdict names, but a value.
fn is_answered(made: &Made, verdict: &Verdict) -> bool {
    let lacks = |what: &str| match what {
        "play" => Some(Effect::Backlash),
        "damping" => Some(Effect::RateDependence),
        _ => None,
    };
    let missing: Vec<Effect> = (made.expected.iter())
        .filter(|(_, [simulator, _])| *simulator == 0.0)
        .filter_map(|(what, _)| lacks(what))
        .collect();
    match verdict.status {
        Status::Named => !missing.is_empty() && verdict.effects == missing,
        Status::Parameters => !made.expected.is_empty() && missing.is_empty(),
        Status::None => made.expected.is_empty(),
        _ => false,
    }
}

/// The name of a row without the number of its pole.
fn unnumbered(what: &str) -> &str {
    what.trim_end_matches(|c: char| c.is_ascii_digit()).trim_end_matches('_')
}

/// The table of differences in the units of the rig.
pub(crate) fn rows(report: &Report) -> Vec<ReportedDifference> {
    let units = Units::of(&report.rig);
    (report.diagnosis.differences.iter())
        .flat_map(|found| found.rows.iter().map(|row| ReportedDifference::of(row, &units)))
        .collect()
}
