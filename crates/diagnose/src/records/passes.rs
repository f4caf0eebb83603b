//! How often a diagnosis went over the records.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Counts passes over all samples of the fit records: features built, errors or derivatives evaluated, sums taken. Clones count together.
///
/// The number depends on the records alone, not on who does the work: every piece of work counts what it does.
#[derive(Debug, Clone, Default)]
pub(crate) struct Passes(Arc<AtomicU64>);

impl Passes {
    /// One pass more.
    pub(crate) fn count(&self) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }

    /// Passes so far.
    pub(crate) fn so_far(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }
}
