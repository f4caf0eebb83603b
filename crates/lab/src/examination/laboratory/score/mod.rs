//! Scoring the judged rigs.

mod accuracy;
mod baseline;
mod calibration;
mod closure;
mod confusion;
mod measure;
mod places;

pub use accuracy::AccuracyRow;
pub use accuracy::SizeRow;
pub use baseline::BaselineRow;
pub use calibration::AbstentionRow;
pub(crate) use calibration::Calibration;
pub use closure::ClosureRow;
pub use confusion::Confusion;
pub use places::PlaceRow;

use super::case::Case;
use super::scenario::Expect;
use crate::examination::Measure;

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
