//! How much there is to do in a study, and in parts of it: what a forecast of its time is made from.

use super::Study;
use super::standing::Standing;
use super::tally::nodes_of;

/// How much a part of a study's first round runs and leaves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ShareSize {
    /// Batches.
    pub batches: usize,
    /// Sets of sums.
    pub nodes: usize,
}

impl Study<'_> {
    /// The sizes of parts of the first round, of which there are so many.
    pub fn shares(&self, parts: usize) -> Vec<ShareSize> {
        let (round, batches) = (0..self.rule.forecast(), self.rule.batches());
        let share = |number| {
            let share = batches.share(round.clone(), (number, parts));
            ShareSize { batches: batches.pieces(share.clone()).count(), nodes: nodes_of(batches, share) }
        };
        (1..=parts).map(share).collect()
    }

    /// Replicates of a batch.
    pub fn batch(&self) -> usize {
        self.rule.batches().size()
    }

    /// Cells, each of which has an estimate from every replicate.
    pub fn cells(&self) -> usize {
        self.specs.len()
    }

    /// Groups of cells that share their noise.
    pub fn workloads(&self) -> usize {
        self.pulses.len() + self.free.len()
    }

    /// Samples of noise that are drawn for a replicate: the longest record of each group of cells.
    pub fn samples_of_a_replicate(&self) -> f64 {
        let longest = |cells: std::ops::Range<usize>| self.specs[cells].iter().map(|spec| spec.samples).max();
        self.cells_of_worlds().into_iter().filter_map(longest).map(|samples| samples as f64).sum()
    }

    /// The study before its first replicate, with one cell of each group that shares noise, and no other.
    pub fn with_one_cell_each(&self) -> Standing {
        let mut standing = self.begin();
        standing.round.active.fill(false);
        for cells in self.cells_of_worlds() {
            if let Some(first) = standing.round.active.get_mut(cells.start) {
                *first = true;
            }
        }
        standing
    }
}

impl Standing {
    /// Sets of sums in it.
    pub fn nodes(&self) -> usize {
        self.tally.nodes().len()
    }

    /// Adds to each set of sums the one of the other standing at its place, as if they were neighbours in the tree of batches: what merging takes.
    pub fn add_to_each(&mut self, other: &Self) {
        self.tally.add_to_each(&other.tally);
    }
}
