//! Running replicates batch after batch, in parallel and reproducibly.

use super::cell::ActiveCells;
use super::memory::Memory;
use super::noise::LaneNoise;
use super::tally::{Node, Tally};
use super::workload::{Chunk, Task, Workload};
use rayon::prelude::*;
use std::mem;
use std::ops::{ControlFlow, Range};

/// Reported how the work goes on; called from several threads.
pub trait Progress: Sync {
    /// So many replicates of the study are to be run, as far as is known now: where a precision is asked for, a forecast from the errors
    /// so far.
    fn planned(&self, replicates: u64);
    /// So many more are done.
    fn advanced(&self, replicates: u64);
    /// So many of all cells are not precise enough yet; reported only where a precision is asked for.
    fn imprecise(&self, _cells: usize, _of: usize) {}
}

/// Reported of every batch that is done.
pub(super) trait Overseer {
    /// So many replicates are added to the tally.
    fn added(&mut self, replicates: usize, tally: &Tally) -> ControlFlow<()>;
    /// Whether the batch running is given up.
    fn is_stopped(&self) -> bool;
}

/// The workloads of a study, and the seed of its noise: replicate `r` sees the same noise whatever else is run.
#[derive(Clone, Copy)]
pub(super) struct Work<'a> {
    pub(super) seed: u64,
    pub(super) workloads: &'a [&'a dyn Workload],
}

impl<'a> Work<'a> {
    /// Runs replicates in the active cells, each of the pieces within one batch, and adds what they leave behind to the tally, batch after batch.
    ///
    /// The pieces go step by step, a step being one workload; while its cells take in their noise, that of the next step is drawn. The threads
    /// wait for each other once a step. The wait is short: drawing, whose tasks are long, comes first, and what is left at the end are short ones.
    pub(super) fn run(
        self,
        pieces: impl Iterator<Item = Range<usize>>,
        active: &[bool],
        tally: &mut Tally,
        overseer: &mut dyn Overseer,
    ) -> ControlFlow<()> {
        let places = self.places(active);
        let mut steps = pieces.flat_map(|piece| Step::all(&piece, &places).collect::<Vec<_>>());
        let (mut drawn, mut ahead): (Vec<LaneNoise>, Vec<LaneNoise>) = Default::default();
        let mut node: Option<Node> = None;
        let mut step: Option<Step<'a>> = None;
        loop {
            let next = steps.next();
            let draw =
                next.as_ref().map(|next| next.workload.draw(self.seed, next.piece.clone(), &mut ahead));
            let take_in = step.as_ref().map(|step| {
                let node = node.get_or_insert_with(|| tally.open(&step.piece));
                step.take_in((self.seed, &drawn), active, node)
            });
            work_off(draw.into_iter().chain(take_in).flatten());
            if let Some(last) = step.filter(|step| step.is_last)
                && let Some(mut whole) = node.take()
            {
                whole.range.end = last.piece.end;
                tally.add(whole);
                overseer.added(last.piece.len(), tally)?;
            }
            if overseer.is_stopped() {
                return ControlFlow::Break(());
            }
            if next.is_none() {
                return ControlFlow::Continue(());
            }
            step = next;
            mem::swap(&mut drawn, &mut ahead);
        }
    }

    /// The workloads that have anything active, and where their cells stand among all.
    fn places(self, active: &[bool]) -> Vec<Place<'a>> {
        let mut places = Vec::with_capacity(self.workloads.len());
        let mut first = 0;
        for &workload in self.workloads {
            let cells = first..first + workload.cells();
            first = cells.end;
            if active[cells.clone()].contains(&true) {
                places.push((workload, cells));
            }
        }
        places
    }
}

/// A workload, and where its cells stand among all.
type Place<'a> = (&'a dyn Workload, Range<usize>);

/// Does the tasks in their order, each as soon as a thread is free.
fn work_off<'a>(tasks: impl Iterator<Item = Task<'a>> + Send) {
    tasks.par_bridge().for_each_init(Memory::default, |memory, task| task(memory));
}

/// A piece of a batch in the cells of one workload.
struct Step<'a> {
    workload: &'a dyn Workload,
    /// Where its cells stand among all.
    cells: Range<usize>,
    piece: Range<usize>,
    /// Whether the piece is done in every workload after it.
    is_last: bool,
}

impl<'a> Step<'a> {
    /// The steps of a piece.
    fn all<'p>(piece: &'p Range<usize>, places: &'p [Place<'a>]) -> impl Iterator<Item = Self> + 'p {
        places.iter().enumerate().map(|(k, (workload, cells))| Self {
            workload: *workload,
            cells: cells.clone(),
            piece: piece.clone(),
            is_last: k + 1 == places.len(),
        })
    }

    /// What is left to do when its noise is drawn.
    fn take_in<'s>(
        &'s self,
        (seed, noise): (u64, &'s [LaneNoise]),
        active: &'s [bool],
        node: &'s mut Node,
    ) -> Vec<Task<'s>> {
        let chunk = Chunk { seed, range: self.piece.clone(), noise };
        let sums = &mut node.cells[self.cells.clone()];
        self.workload.take_in(chunk, ActiveCells { active: &active[self.cells.clone()], sums })
    }
}
