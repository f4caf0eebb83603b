//! Shares with their intervals, and the lines of a summary: what must be reached, what was.

use serde::{Deserialize, Serialize};
use std::fmt::Write;

/// A share of counted rigs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Share {
    /// Rigs for which it holds.
    pub count: usize,
    /// Rigs counted.
    pub of: usize,
}

impl Share {
    /// Counts over some cases.
    pub(crate) fn over<'a, C: 'a>(cases: impl Iterator<Item = &'a C>, holds: impl Fn(&C) -> bool) -> Self {
        cases.fold(Self::default(), |s, c| Self { count: s.count + usize::from(holds(c)), of: s.of + 1 })
    }

    /// The share; none of nothing.
    pub fn value(self) -> Option<f64> {
        (self.of > 0).then(|| self.count as f64 / self.of as f64)
    }

    /// Its 95 % interval (Wilson, J. Am. Stat. Assoc. 22, 1927): what other rigs drawn alike may say.
    pub fn interval(self) -> Option<[f64; 2]> {
        const Z: f64 = 1.96;
        let (p, n) = (self.value()?, self.of as f64);
        let centre = p + Z * Z / (2.0 * n);
        let half = Z * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt();
        let scale = 1.0 + Z * Z / n;
        Some([((centre - half) / scale).max(0.0), ((centre + half) / scale).min(1.0)])
    }
}

/// What a figure must be.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Bound {
    /// At least this.
    AtLeast(f64),
    /// At most this.
    AtMost(f64),
    /// From the first to the second.
    Within(f64, f64),
}

impl Bound {
    /// Whether a figure meets the bound.
    pub(crate) fn holds(self, x: f64) -> bool {
        match self {
            Self::AtLeast(low) => x >= low,
            Self::AtMost(high) => x <= high,
            Self::Within(low, high) => (low..=high).contains(&x),
        }
    }
}

/// One line of the summary.
#[derive(Debug, Clone, PartialEq)]
pub struct Measure {
    /// The key in `[expect]`.
    pub key: &'static str,
    /// What is measured.
    pub text: &'static str,
    /// What must be reached.
    pub target: Option<Bound>,
    /// What the scenario expects.
    pub expected: Option<Bound>,
    /// What was reached; none where no rig shows.
    pub reached: Option<f64>,
    /// Its 95 % interval, where it is a share of rigs.
    pub interval: Option<[f64; 2]>,
    /// Rigs that show, or cells for *where*.
    pub rigs: usize,
    /// Whether it is a share, reported in percent.
    pub in_percent: bool,
}

/// What was reached, its interval, and how many rigs show.
pub(crate) type Reached = (Option<f64>, Option<[f64; 2]>, usize);

/// A measure of an examination whose expectations are `E`: its key, what is measured, where its bound stands among expectations, and what was
/// reached.
pub(crate) type Line<E> = (&'static str, &'static str, fn(&E) -> Option<Bound>, Reached);

/// Lines with what must be reached and what a scenario expects; all are shares but those whose keys are given.
pub(crate) fn bounded<E, const N: usize>(
    lines: [Line<E>; N],
    (targets, expect): (&E, &E),
    no_shares: &[&str],
) -> Vec<Measure> {
    let measure = |(key, text, bound, (reached, interval, rigs)): Line<E>| Measure {
        key,
        text,
        target: bound(targets),
        expected: bound(expect),
        reached,
        interval,
        rigs,
        in_percent: !no_shares.contains(&key),
    };
    lines.into_iter().map(measure).collect()
}

impl Measure {
    /// Whether the target is met, where a rig shows.
    pub(crate) fn meets_target(&self) -> Option<bool> {
        Some(self.target?.holds(self.reached?))
    }

    /// Whether the scenario's expectation is broken. A figure that no rig shows breaks it, too.
    pub(crate) fn is_unexpected(&self) -> bool {
        self.expected.is_some_and(|bound| !self.reached.is_some_and(|x| bound.holds(x)))
    }

    /// Shares in percent, everything else as it is.
    fn figure(&self, x: f64) -> String {
        if self.in_percent { format!("{:.1} %", 100.0 * x) } else { format!("{x:.3}") }
    }

    fn reported(&self, bound: Bound) -> String {
        match bound {
            Bound::AtLeast(x) => format!("≥ {}", self.figure(x)),
            Bound::AtMost(x) => format!("≤ {}", self.figure(x)),
            Bound::Within(low, high) => format!("{:.0}–{:.0} %", 100.0 * low, 100.0 * high),
        }
    }

    fn unexpected(&self) -> String {
        match self.expected.filter(|_| self.is_unexpected()) {
            Some(bound) => format!("  UNEXPECTED: the scenario wants {}", self.reported(bound)),
            None => String::new(),
        }
    }
}

/// The table of measures, as printed: measure, what must be reached, what was and its 95 % interval, how many
/// rigs show.
pub(crate) fn measures_table(measures: &[Measure]) -> String {
    let mut text = format!(
        "{:51} {:>11} {:>9} {:>15} {:>6}\n",
        "measure", "must reach", "reached", "95 % interval", "rigs"
    );
    for measure in measures {
        let reached = measure.reached.map_or_else(|| "—".to_owned(), |x| measure.figure(x));
        let mark = match (measure.reached, measure.meets_target()) {
            (None, _) => "  not reported",
            (_, Some(false)) => "  short",
            _ => "",
        };
        let interval = measure
            .interval
            .map_or_else(String::new, |[low, high]| format!("{:.1}–{:.1} %", 100.0 * low, 100.0 * high));
        let target = measure.target.map_or_else(String::new, |bound| measure.reported(bound));
        let (what, rigs, broken) = (measure.text, measure.rigs, measure.unexpected());
        let _ = writeln!(text, "{what:51} {target:>11} {reached:>9} {interval:>15} {rigs:>6}{mark}{broken}");
    }
    text
}
