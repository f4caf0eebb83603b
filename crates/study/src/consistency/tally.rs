//! What the replicates of a study left behind, added up in one order whoever ran them and in which pieces.
//!
//! Batches are the leaves of a binary tree: two neighbours of `2ᵏ` batches, the first of which begins at a multiple of `2ᵏ⁺¹`, make one
//! node. A run of replicates is thus a few nodes, always the same ones, each the sum of the same two: sums of floating-point numbers
//! depend on their order, and this one knows of no shards and no interruptions.

use super::batches::Batches;
use super::sections::{CellShape, CellSums};
use rayon::prelude::*;
use std::ops::Range;

/// The sums of a run of replicates, one a cell.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Node {
    pub(super) range: Range<usize>,
    pub(super) cells: Vec<CellSums>,
}

impl Node {
    fn merge(&mut self, other: &Self) {
        self.range.end = other.range.end;
        self.cells.par_iter_mut().zip(&other.cells).for_each(|(into, from)| into.merge(from));
    }
}

/// Some replicates of every cell, in nodes by their numbers.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tally {
    batches: Batches,
    /// What the sums of each cell hold.
    shape: Vec<CellShape>,
    nodes: Vec<Node>,
}

impl Tally {
    pub(super) fn new(batches: Batches, shape: Vec<CellShape>) -> Self {
        Self { batches, shape, nodes: Vec::new() }
    }

    pub(super) fn batches(&self) -> Batches {
        self.batches
    }

    pub(super) fn shape(&self) -> &[CellShape] {
        &self.shape
    }

    pub(super) fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    pub(super) fn into_nodes(self) -> impl Iterator<Item = Node> {
        self.nodes.into_iter()
    }

    /// How many there are.
    pub(super) fn replicates(&self) -> usize {
        self.nodes.iter().map(|node| node.range.len()).sum()
    }

    /// Takes the node that a piece of a batch belongs to, to add its replicates: that of the replicates just before it in the batch, or an
    /// empty one. [`add`](Self::add) puts it back.
    pub(super) fn open(&mut self, piece: &Range<usize>) -> Node {
        let goes_on = |node: &mut Node| {
            node.range.end == piece.start && !node.range.end.is_multiple_of(self.batches.size())
        };
        self.nodes.pop_if(goes_on).unwrap_or_else(|| Node {
            range: piece.start..piece.start,
            cells: self.shape.iter().map(|&shape| CellSums::new(shape)).collect(),
        })
    }

    /// Adds a node that begins where the last one ends, or later.
    pub(super) fn add(&mut self, node: Node) {
        let mut last = node;
        while let Some(before) =
            self.nodes.pop_if(|before| self.batches.are_siblings(&before.range, &last.range))
        {
            let after = std::mem::replace(&mut last, before);
            last.merge(&after);
        }
        self.nodes.push(last);
    }

    /// The first gap or overlap between the nodes, and up to `end`: where the next should begin, and where it does.
    pub(super) fn first_break(&self, end: usize) -> Option<(usize, usize)> {
        let starts = self.nodes.iter().map(|node| node.range.start).chain([end]);
        let ends = [0].into_iter().chain(self.nodes.iter().map(|node| node.range.end));
        ends.zip(starts).find(|(end, start)| end != start)
    }

    /// Where the last node ends; `start` if there is none.
    pub(super) fn end(&self, start: usize) -> usize {
        self.nodes.last().map_or(start, |node| node.range.end)
    }

    /// The sums over all replicates, one a cell.
    pub(super) fn totals(&self) -> Vec<CellSums> {
        let of_cell = |(cell, &shape): (usize, &CellShape)| {
            let mut total = CellSums::new(shape);
            self.nodes.iter().for_each(|node| total.merge(&node.cells[cell]));
            total
        };
        self.shape.par_iter().enumerate().map(of_cell).collect()
    }
}

impl Batches {
    /// Whether two runs of replicates that follow each other make one node of the tree. The second may be cut short, by the end of all.
    fn are_siblings(self, first: &Range<usize>, second: &Range<usize>) -> bool {
        let (size, start) = (first.len(), first.start);
        first.end == second.start
            && size.is_multiple_of(self.size())
            && (size / self.size()).is_power_of_two()
            && start.is_multiple_of(2 * size)
            && second.len() == size
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use switchback_identify::statistics::ReplicateError;

    /// Runs a piece as the engine does: every section by itself, in order.
    fn run(tally: &mut Tally, range: Range<usize>) {
        for piece in tally.batches.pieces(range) {
            let mut node = tally.open(&piece);
            for replicate in piece.clone() {
                let section = super::super::sections::section(replicate);
                let mut sums = node.cells[0].section(section);
                let error = (replicate as f64 * 0.7).sin();
                let of = ReplicateError {
                    error,
                    se: 0.7,
                    first_order: Some(error * 0.9),
                    second_order: 0.01,
                    first_order_variance: Some(0.4),
                };
                sums.parameters[0].push(of);
                sums.runs.replicates = 1;
                if replicate.is_multiple_of(97) {
                    sums.runs.fail(replicate as u32, "none".to_owned());
                }
                node.cells[0].put_section(section, &sums);
            }
            node.range.end = piece.end;
            tally.add(node);
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn pieces_and_shards_add_up_to_the_bits_of_one_run(
            end in 1..1500_usize, mut cuts in prop::collection::vec(0..1500_usize, 0..6), of in 1..30_usize,
        ) {
            let batches = Batches::with_size(32);
            let empty = Tally::new(batches, vec![CellShape { parameters: 1, controls: None }]);
            let mut whole = empty.clone();
            run(&mut whole, 0..end);
            prop_assert_eq!(whole.first_break(end), None);

            cuts.retain(|cut| *cut < end);
            cuts.extend([0, end]);
            cuts.sort_unstable();
            let mut pieces = empty.clone();
            cuts.windows(2).for_each(|w| run(&mut pieces, w[0]..w[1]));
            prop_assert_eq!(&pieces, &whole);

            let mut merged = empty.clone();
            for number in 1..=of {
                let mut shard = empty.clone();
                run(&mut shard, batches.share(0..end, (number, of)));
                shard.nodes.into_iter().for_each(|node| merged.add(node));
            }
            prop_assert_eq!(&merged, &whole);
            let total = &whole.totals()[0];
            prop_assert_eq!(total.runs.replicates, end);
            prop_assert_eq!(total.parameters(None)[0].count(), end);
        }
    }

    #[test]
    fn breaks_are_found() {
        let mut tally = Tally::new(Batches::with_size(16), vec![CellShape { parameters: 1, controls: None }]);
        assert_eq!(tally.first_break(48), Some((0, 48)));
        run(&mut tally, 16..32);
        assert_eq!(tally.first_break(48), Some((0, 16)));
        let mut tally = Tally::new(Batches::with_size(16), vec![CellShape { parameters: 1, controls: None }]);
        run(&mut tally, 0..20);
        assert_eq!(tally.first_break(48), Some((20, 48)));
        run(&mut tally, 20..48);
        assert_eq!(tally.first_break(48), None);
        assert_eq!(tally.end(0), 48);
    }

    #[test]
    fn a_part_keeps_few_nodes_however_long_it_is() {
        let batches = Batches::with_size(16);
        for (end, of) in [(16 * 469, 24), (16 * 5000, 24), (16 * 5000, 7), (16 * 777, 3)] {
            let nodes = |number| {
                let mut tally = Tally::new(batches, Vec::new());
                let pieces = batches.pieces(batches.share(0..end, (number, of)));
                pieces.for_each(|range| tally.add(Node { range, cells: Vec::new() }));
                tally.nodes.len()
            };
            let counts: Vec<usize> = (1..=of).map(nodes).collect();
            assert!(counts.iter().all(|count| *count <= 6), "{counts:?}");
            assert!(counts.iter().sum::<usize>() <= 3 * of + 3, "{counts:?}");
        }
    }
}
