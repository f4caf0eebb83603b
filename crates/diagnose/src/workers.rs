//! Independent pieces of work, done by whoever the caller lends.

use crate::phase::Phase;

/// Runs independent pieces of work; the caller decides on how many threads. Results come in the order of the items, so that a
/// diagnosis does not depend on who did what.
pub trait Workers: Sync {
    /// `work` applied to each item.
    fn map<T: Sync, R: Send>(&self, items: &[T], work: impl Fn(&T) -> R + Sync + Send) -> Vec<R>;

    /// Hears that a phase begins.
    fn begin(&self, _phase: Phase) {}
}

/// One piece after the other.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Serial;

impl Workers for Serial {
    fn map<T: Sync, R: Send>(&self, items: &[T], work: impl Fn(&T) -> R + Sync + Send) -> Vec<R> {
        items.iter().map(work).collect()
    }
}
