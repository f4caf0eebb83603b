//! The replicates between two looks at the stopping rule, in chunks and sections.

use super::sections::SECTIONS;
use std::ops::Range;

/// Replicates of one noise pass: a whole number of lanes at every width.
pub(super) const BATCH: usize = 16;

/// Least and largest number of replicates in a chunk, of which two are held at once, one being drawn and one being taken in: what begins anew
/// with each chunk costs less a replicate in the larger, and memory more.
const CHUNKS: [usize; 2] = [8 * BATCH, 32 * BATCH];

/// The replicates between two looks at the stopping rule.
#[derive(Debug, Clone)]
pub(super) struct Round {
    pub(super) seed: u64,
    pub(super) range: Range<usize>,
}

impl Round {
    /// Its replicates in chunks: about sixteen, so that progress is seen.
    pub(super) fn chunks(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        let [least, largest] = CHUNKS;
        let chunk = (self.range.len() / 16).next_multiple_of(BATCH).clamp(least, largest);
        self.range.clone().step_by(chunk).map(move |start| start..self.range.end.min(start + chunk))
    }

    /// The section that a replicate belongs to: sections are contiguous and of (nearly) equal size.
    pub(super) fn section(&self, replicate: usize) -> usize {
        ((replicate - self.range.start + 1) * SECTIONS).div_ceil(self.range.len()) - 1
    }
}
