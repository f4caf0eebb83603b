//! Working memory that one family of cells leaves to the next.

use switchback_estimator::estimators::pulse::lanes::{LaneFit, LaneStatistics, LaneStep, LaneTerms};
use switchback_estimator::simulation::{LaneCross, LaneSuperposition};

/// Groups of eight replicates that a cell takes in before the next: so many statistics, and one cell's sums, stay in the cache.
pub(super) const LANES_AT_ONCE: usize = 4;

/// What one family leaves to the next: memory.
#[derive(Default)]
pub(super) struct Memory {
    /// One a group of eight replicates.
    pub(super) crosses: Vec<[LaneCross; 2]>,
    pub(super) few: Few,
}

/// A few groups of eight replicates at one noise level.
#[derive(Default)]
pub(super) struct Few {
    pub(super) statistics: [[LaneStatistics; 2]; LANES_AT_ONCE],
    pub(super) steps: [[LaneStep; 2]; LANES_AT_ONCE],
    pub(super) fits: [LaneFit; LANES_AT_ONCE],
    pub(super) terms: [LaneTerms; LANES_AT_ONCE],
}

impl Few {
    /// Makes room for the statistics of a family.
    pub(super) fn shape(&mut self, superpositions: &[LaneSuperposition; 2]) {
        for statistics in &mut self.statistics {
            statistics.iter_mut().zip(superpositions).for_each(|(s, from)| from.shape(s));
        }
    }
}
