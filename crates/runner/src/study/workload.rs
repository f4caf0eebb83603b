//! What runs the replicates of some cells, and in which pieces.

use super::cell::ActiveCells;
use super::memory::Memory;
use super::noise::LaneNoise;
use super::round::Round;
use super::sections::CellSums;
use rayon::prelude::*;
use std::ops::Range;

/// Work that may go on beside other work, in memory that earlier tasks have left behind.
pub(super) type Task<'a> = Box<dyn FnOnce(&mut Memory) + Send + 'a>;

/// Cells whose replicates are run together: noise is drawn, then the cells take it in.
///
/// Every kind of experiment has its own; the rounds, sections and stopping rule know this much of them only. The outcome depends on the seed
/// and the replicates' numbers, not on threads or on what else is active.
pub(super) trait Workload: Sync {
    /// How many cells there are.
    fn cells(&self) -> usize;

    /// Draws the noise of the replicates `chunk` of a round, whatever `noise` held before; none where a replicate draws its own when the cells
    /// take it in.
    fn draw<'a>(
        &'a self,
        _round: &'a Round,
        _chunk: Range<usize>,
        noise: &'a mut Vec<LaneNoise>,
    ) -> Vec<Task<'a>> {
        noise.clear();
        Vec::new()
    }

    /// Runs the replicates `chunk` of a round, whose noise has been drawn, in every active cell and adds what came out to their sums.
    fn take_in<'a>(&'a self, chunk: Chunk<'a>, cells: ActiveCells<'a>) -> Vec<Task<'a>>;
}

/// Some replicates of a round with their noise.
#[derive(Debug, Clone)]
pub(super) struct Chunk<'a> {
    pub(super) round: &'a Round,
    pub(super) range: Range<usize>,
    pub(super) noise: &'a [LaneNoise],
}

/// One task that runs the replicates of a chunk one by one, each drawing its own noise: `replicate` takes the seed, the replicate's number and
/// which cells are active, and adds to the cells' sums.
pub(super) fn one_by_one<'a>(
    chunk: Chunk<'a>,
    cells: ActiveCells<'a>,
    replicate: impl Fn(u64, u32, &[bool], &mut [CellSums]) + Send + Sync + 'a,
) -> Vec<Task<'a>> {
    let ActiveCells { active, sums } = cells;
    let seed = chunk.round.seed;
    vec![Box::new(move |_| by_sections(&chunk, sums, |r, sums| replicate(seed, r, active, sums)))]
}

/// Runs the replicates of a chunk one by one in parallel: each section's part is summed on its own, and the parts are added in order.
fn by_sections(
    chunk: &Chunk<'_>,
    cells: &mut [Vec<CellSums>],
    replicate: impl Fn(u32, &mut [CellSums]) + Sync,
) {
    let round = chunk.round;
    let replicates: Vec<usize> = chunk.range.clone().collect();
    let parts: Vec<&[usize]> = replicates.chunk_by(|r, s| round.section(*r) == round.section(*s)).collect();
    let empty: Vec<CellSums> =
        cells.iter().map(|sections| CellSums::new(sections[0].parameters.len())).collect();
    let sums: Vec<Vec<CellSums>> = parts
        .par_iter()
        .map(|part| {
            let mut sums = empty.clone();
            part.iter().for_each(|&r| replicate(r as u32, &mut sums));
            sums
        })
        .collect();
    for (part, sums) in parts.iter().zip(&sums) {
        let section = round.section(part[0]);
        cells.iter_mut().zip(sums).for_each(|(cell, sums)| cell[section].merge(sums));
    }
}
