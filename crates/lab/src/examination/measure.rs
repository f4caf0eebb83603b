//! The lines of a summary: what must be reached, what was.

use super::share::Share;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt::Write;

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

/// What a scenario expects, by the keys of the measures.
pub type Expect = BTreeMap<String, Bound>;

/// What a measure must reach, and how a scenario may bound it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Target {
    /// This must be reached; a scenario may bound it on the same side.
    Must(Bound),
    /// Nothing must be reached; a scenario may bound it from above.
    BoundedAbove,
    /// It is only reported.
    Reported,
}

/// What was reached.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Reached {
    /// A share of rigs.
    Share(Share),
    /// Another figure, none where no rig shows, and how many rigs or cells do.
    Figure(Option<f64>, usize),
}

/// A measure of what is known of type `S`: its key, what is measured, its target, and how it is computed.
pub(crate) type Line<S> = (&'static str, &'static str, Target, fn(&S) -> Reached);

/// One line of the summary; the same type writes and reads it in results.json.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Measure {
    /// The key in `[expect]`.
    pub key: String,
    /// What is measured.
    #[serde(rename = "measure")]
    pub text: String,
    /// What must be reached.
    #[serde(rename = "must_reach")]
    pub target: Option<Bound>,
    /// What the scenario expects.
    pub expected: Option<Bound>,
    /// What was reached; none where no rig shows.
    pub reached: Option<f64>,
    /// Its 95 % interval, where it is a share of rigs.
    pub interval: Option<[f64; 2]>,
    /// Rigs that show, or cells for *where*.
    pub rigs: usize,
    /// Whether the target is met, where a rig shows.
    pub meets: Option<bool>,
    /// Whether it is a share, reported in percent.
    #[serde(default = "in_percent")]
    pub in_percent: bool,
}

fn in_percent() -> bool {
    true
}

/// Every line with what was reached and what the scenario expects.
pub(crate) fn measures<S>(lines: &[Line<S>], known: &S, expect: &Expect) -> Vec<Measure> {
    let measure = |(key, text, target, compute): &Line<S>| {
        let (reached, interval, rigs, in_percent) = match compute(known) {
            Reached::Share(share) => (share.value(), share.interval(), share.of, true),
            Reached::Figure(figure, rigs) => (figure, None, rigs, false),
        };
        let target = if let Target::Must(bound) = target { Some(*bound) } else { None };
        Measure {
            key: (*key).to_owned(),
            text: (*text).to_owned(),
            target,
            expected: expect.get(*key).copied(),
            meets: target.zip(reached).map(|(bound, x)| bound.holds(x)),
            reached,
            interval,
            rigs,
            in_percent,
        }
    };
    lines.iter().map(measure).collect()
}

impl Measure {
    /// Whether the scenario's expectation is broken. A figure that no rig shows breaks it, too.
    pub(crate) fn is_unexpected(&self) -> bool {
        self.expected.is_some_and(|bound| !self.reached.is_some_and(|x| bound.holds(x)))
    }

    /// Shares in percent, everything else as it is.
    pub fn figure(&self, x: f64) -> String {
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
        let mark = match (measure.reached, measure.meets) {
            (None, _) => "  not reported",
            (_, Some(false)) => "  short",
            _ => "",
        };
        let interval = measure
            .interval
            .map_or_else(String::new, |[low, high]| format!("{:.1}–{:.1} %", 100.0 * low, 100.0 * high));
        let target = measure.target.map_or_else(String::new, |bound| measure.reported(bound));
        let (what, rigs, broken) = (&measure.text, measure.rigs, measure.unexpected());
        let _ = writeln!(text, "{what:51} {target:>11} {reached:>9} {interval:>15} {rigs:>6}{mark}{broken}");
    }
    text
}
