//! What the replicates of a cell left behind: sums, by section.

use serde::{Deserialize, Serialize};
use switchback_estimator::estimators::pulse::ErrorTerms;
use switchback_estimator::estimators::pulse::lanes::LANES;
use switchback_estimator::statistics::{ErrorSums, LaneSums, ReplicateError};

/// Replicates are kept in so many sections, so that any figure drawn from several cells can be jackknifed: two for each lane.
pub(super) const SECTIONS: usize = 2 * LANES;

/// Failed replicates that are kept by number; the rest are only counted.
const KEPT_FAILURES: usize = 100;

/// The section of a replicate: they take turns, so that a study may go on at any number.
pub(super) fn section(replicate: usize) -> usize {
    replicate % SECTIONS
}

/// A replicate without an estimate.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Failure {
    pub(super) replicate: usize,
    pub(super) reason: String,
}

/// How many replicates were run, and which of them have no estimate.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Runs {
    /// Replicates run, failed ones included.
    pub(super) replicates: usize,
    pub(super) failed: usize,
    /// The first of them, by number.
    pub(super) failures: Vec<Failure>,
}

impl Runs {
    pub(super) fn fail(&mut self, replicate: u32, reason: String) {
        self.failed += 1;
        if self.failures.len() < KEPT_FAILURES {
            self.failures.push(Failure { replicate: replicate as usize, reason });
        }
    }

    fn merge(&mut self, other: &Self) {
        self.replicates += other.replicates;
        self.failed += other.failed;
        self.failures.extend(other.failures.iter().cloned());
        self.failures.sort_by_key(|failure| failure.replicate);
        self.failures.truncate(KEPT_FAILURES);
    }
}

/// One section of a cell's replicates.
#[derive(Debug, Clone)]
pub(super) struct SectionSums {
    /// One a parameter.
    pub(super) parameters: Vec<ErrorSums>,
    pub(super) runs: Runs,
}

impl SectionSums {
    /// Adds a replicate: the errors with the standard errors that the method reports, and their leading terms.
    pub(super) fn push(&mut self, errors: impl Iterator<Item = (f64, f64)>, terms: &ErrorTerms) {
        let terms = terms.first.iter().zip(&terms.second);
        for (((error, se), (&first, &second_order)), sums) in errors.zip(terms).zip(&mut self.parameters) {
            sums.push(ReplicateError { error, se, first_order: Some(first), second_order });
        }
    }
}

/// All sections of a cell's replicates.
///
/// Every section adds its replicates one after the other, by number: a run that stops anywhere and goes on has the bits of one that did not.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CellSums {
    /// Sections 0 to 7, and 8 to 15.
    halves: [LaneSums; 2],
    pub(super) runs: Runs,
}

impl CellSums {
    pub(super) fn new(parameters: usize) -> Self {
        Self { halves: [0, 1].map(|_| LaneSums::new(parameters)), runs: Runs::default() }
    }

    /// Puts together what [`halves`](Self::halves) and `runs` hold.
    pub(super) fn of(halves: [LaneSums; 2], runs: Runs) -> Self {
        Self { halves, runs }
    }

    pub(super) fn halves(&self) -> &[LaneSums; 2] {
        &self.halves
    }

    /// The sums that eight replicates belong to, of which this is the first.
    pub(super) fn of_eight(&mut self, first: u32) -> &mut LaneSums {
        &mut self.halves[first as usize / LANES % 2]
    }

    /// A section's sums as they stand, without the counts.
    pub(super) fn section(&self, section: usize) -> SectionSums {
        SectionSums { parameters: self.halves[section / LANES].lane(section % LANES), runs: Runs::default() }
    }

    /// Puts back what [`section`](Self::section) gave, with more replicates in it.
    pub(super) fn put_section(&mut self, section: usize, sums: &SectionSums) {
        self.halves[section / LANES].set_lane(section % LANES, &sums.parameters);
        self.runs.merge(&sums.runs);
    }

    /// Adds the sums of other replicates, section for section.
    pub(super) fn merge(&mut self, other: &Self) {
        self.halves.iter_mut().zip(&other.halves).for_each(|(into, from)| into.merge(from));
        self.runs.merge(&other.runs);
    }

    /// The sums over all sections, or over all but one, one a parameter.
    pub(super) fn parameters(&self, without: Option<usize>) -> Vec<ErrorSums> {
        let mut all = vec![ErrorSums::default(); self.halves[0].parameters()];
        for section in (0..SECTIONS).filter(|section| Some(*section) != without) {
            let sums = self.section(section).parameters;
            all.iter_mut().zip(&sums).for_each(|(into, from)| into.merge(from));
        }
        all
    }
}
