//! What the replicates left behind: sums, by section and cell.

use switchback_estimator::estimators::pulse::ErrorTerms;
use switchback_estimator::statistics::{ErrorSums, ReplicateError};

/// Replicates are kept in this many sections of (nearly) equal size, so that any figure drawn from several cells can be jackknifed.
pub(super) const SECTIONS: usize = 20;

/// Failed replicates that are kept by number; the rest are only counted.
const KEPT_FAILURES: usize = 100;

/// The sums of one cell.
#[derive(Debug, Clone, Default)]
pub(super) struct CellSums {
    /// One a parameter.
    pub(super) parameters: Vec<ErrorSums>,
    /// Replicates run, failed ones included.
    pub(super) replicates: usize,
    pub(super) failed: usize,
    /// The first of them.
    pub(super) failures: Vec<usize>,
    pub(super) reason: Option<String>,
}

impl CellSums {
    pub(super) fn new(parameters: usize) -> Self {
        Self { parameters: vec![ErrorSums::default(); parameters], ..Self::default() }
    }

    /// Adds a replicate: the errors with the standard errors that the method reports, and their leading terms.
    pub(super) fn push(&mut self, errors: impl Iterator<Item = (f64, f64)>, terms: &ErrorTerms) {
        let terms = terms.first.iter().zip(&terms.second);
        for (((error, se), (&first, &second_order)), sums) in errors.zip(terms).zip(&mut self.parameters) {
            sums.push(ReplicateError { error, se, first_order: Some(first), second_order });
        }
    }

    pub(super) fn fail(&mut self, replicate: u32, reason: String) {
        self.failed += 1;
        if self.failures.len() < KEPT_FAILURES {
            self.failures.push(replicate as usize);
        }
        self.reason.get_or_insert(reason);
    }

    pub(super) fn merge(&mut self, other: &Self) {
        self.parameters.iter_mut().zip(&other.parameters).for_each(|(into, from)| into.merge(from));
        self.replicates += other.replicates;
        self.failed += other.failed;
        self.failures.extend(&other.failures);
        self.failures.sort_unstable();
        self.failures.truncate(KEPT_FAILURES);
        if self.reason.is_none() {
            self.reason.clone_from(&other.reason);
        }
    }
}

/// Every cell's sums, section for section; cells are in the order of the noise groups, then of their own.
#[derive(Debug, Clone)]
pub(super) struct Sections {
    sums: Vec<Vec<CellSums>>,
}

impl Sections {
    pub(super) fn new(parameters: &[usize]) -> Self {
        Self { sums: parameters.iter().map(|&p| vec![CellSums::new(p); SECTIONS]).collect() }
    }

    pub(super) fn by_cell(&mut self) -> &mut [Vec<CellSums>] {
        &mut self.sums
    }

    /// A cell over all sections, or over all but one.
    pub(super) fn cell(&self, cell: usize, without: Option<usize>) -> CellSums {
        let mut all = CellSums::new(self.sums[cell][0].parameters.len());
        self.sums[cell]
            .iter()
            .enumerate()
            .filter(|(section, _)| Some(*section) != without)
            .for_each(|(_, sums)| all.merge(sums));
        all
    }
}
