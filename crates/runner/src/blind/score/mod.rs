//! Scoring the judged rigs.

mod accuracy;
mod baseline;
mod calibration;
mod closure;
mod confusion;
mod measure;
mod places;

pub use accuracy::{AccuracyRow, SizeRow};
pub use baseline::BaselineRow;
pub use calibration::{AbstentionRow, Calibration, CalibrationBin};
pub use closure::ClosureRow;
pub use confusion::Confusion;
pub use measure::{Bound, Measure, TARGETS};
pub use places::PlaceRow;

use super::case::Case;
use super::scenario::Expect;

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
    pub fn over<'a>(cases: impl Iterator<Item = &'a Case>, holds: impl Fn(&Case) -> bool) -> Self {
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

/// All tables of a blind study.
#[derive(Debug, Clone)]
pub struct Scores {
    /// The summary: what must be reached, what was.
    pub measures: Vec<Measure>,
    /// What was put in against what was said.
    pub confusion: Confusion,
    /// An effect, size and kind of law at a time.
    pub accuracy: Vec<AccuracyRow>,
    /// A size at a time.
    pub sizes: Vec<SizeRow>,
    /// Claimed probability against share of truth.
    pub calibration: Calibration,
    /// What is gained by staying silent below a probability.
    pub abstention: Vec<AbstentionRow>,
    /// Closure an effect at a time.
    pub closure: Vec<ClosureRow>,
    /// Where, an axis at a time.
    pub places: Vec<PlaceRow>,
    /// The diagnosis beside simpler rules.
    pub baselines: Vec<BaselineRow>,
}

/// Computes every table.
pub fn score(cases: &[Case], expect: &Expect) -> Scores {
    let calibration = calibration::calibration(cases);
    let places = places::rows(cases);
    Scores {
        measures: measure::measures(cases, &calibration, &places, expect),
        confusion: confusion::confusion(cases),
        accuracy: accuracy::rows(cases),
        sizes: accuracy::by_size(cases),
        abstention: calibration::abstention(cases),
        closure: closure::rows(cases),
        baselines: baseline::rows(cases),
        calibration,
        places,
    }
}

#[cfg(test)]
mod tests;
