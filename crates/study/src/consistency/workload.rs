//! What runs the replicates of some cells, and in which pieces.

use super::cell::ActiveCells;
use super::memory::Memory;
use super::noise::LaneNoise;
use super::sections::{CellSums, SECTIONS, SectionSums, section};
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

    /// Draws the noise of some replicates, whatever `noise` held before; none where a replicate draws its own when the cells take it in.
    fn draw<'a>(
        &'a self,
        _seed: u64,
        _replicates: Range<usize>,
        noise: &'a mut Vec<LaneNoise>,
    ) -> Vec<Task<'a>> {
        noise.clear();
        Vec::new()
    }

    /// Runs the replicates of a chunk, whose noise has been drawn, in every active cell and adds what came out to their sums.
    fn take_in<'a>(&'a self, chunk: Chunk<'a>, cells: ActiveCells<'a>) -> Vec<Task<'a>>;
}

/// Some replicates of a batch with their noise.
#[derive(Debug, Clone)]
pub(super) struct Chunk<'a> {
    pub(super) seed: u64,
    pub(super) range: Range<usize>,
    pub(super) noise: &'a [LaneNoise],
}

/// One task that runs the replicates of a chunk one by one, each drawing its own noise: `replicate` takes the seed, the replicate's number and
/// which cells are active, and adds to the cells' sums.
pub(super) fn one_by_one<'a>(
    chunk: Chunk<'a>,
    cells: ActiveCells<'a>,
    replicate: impl Fn(u64, u32, &[bool], &mut [SectionSums]) + Send + Sync + 'a,
) -> Vec<Task<'a>> {
    let ActiveCells { active, sums } = cells;
    let seed = chunk.seed;
    vec![Box::new(move |_| by_sections(&chunk.range, sums, |r, sums| replicate(seed, r, active, sums)))]
}

/// Runs replicates one by one, the sections in parallel: each adds its own in order.
fn by_sections(
    range: &Range<usize>,
    cells: &mut [CellSums],
    replicate: impl Fn(u32, &mut [SectionSums]) + Sync,
) {
    let sums: Vec<Vec<SectionSums>> = (0..SECTIONS)
        .into_par_iter()
        .map(|own| {
            let mut sums: Vec<SectionSums> = cells.iter().map(|cell| cell.section(own)).collect();
            range.clone().filter(|r| section(*r) == own).for_each(|r| replicate(r as u32, &mut sums));
            sums
        })
        .collect();
    for (section, sums) in sums.iter().enumerate() {
        cells.iter_mut().zip(sums).for_each(|(cell, sums)| cell.put_section(section, sums));
    }
}
