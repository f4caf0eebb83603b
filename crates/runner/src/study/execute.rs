//! Running the replicates, in parallel and reproducibly.

use super::cell::{ActiveCells, CellSpec};
use super::memory::Memory;
use super::noise::LaneNoise;
use super::round::{BATCH, Round};
use super::sections::{SECTIONS, Sections};
use super::workload::{Chunk, Task, Workload};
use crate::scenario::{Replication, Scenario, Stopping};
use rayon::prelude::*;
use std::mem;
use std::ops::Range;

/// Told how the work goes on; called from several threads.
pub trait Progress: Sync {
    /// So many replicates of the study are to be run, as far as is known now: where a precision is asked for, a forecast from the errors
    /// so far.
    fn planned(&self, replicates: u64);
    /// So many more are done.
    fn advanced(&self, replicates: u64);
    /// So many of all cells are not precise enough yet; told only where a precision is asked for.
    fn imprecise(&self, _cells: usize, _of: usize) {}
}

/// Runs replicates until the scenario has enough of them.
///
/// Replicates are numbered; number `r` sees the same noise whatever else is run. Each round gives every section a contiguous range of them.
pub(super) fn run(
    scenario: &Scenario,
    workloads: &[&dyn Workload],
    specs: &[CellSpec],
    progress: &dyn Progress,
) -> Outcome {
    let parameters: Vec<usize> = specs.iter().map(|s| s.parameters.len()).collect();
    let mut sections = Sections::new(&parameters);
    let mut active = vec![true; parameters.len()];
    let replication = scenario.replication();
    let mut next = Next::first(&replication);
    let mut done = 0;
    while done < next.target {
        progress.planned(next.forecast as u64);
        let round = Round { seed: scenario.seed(), range: done..next.target };
        let places = places(workloads, &active);
        run_steps(&round, Step::all(&round, &places), (&active, &mut sections), progress);
        done = next.target;
        if let Some(stopping) = replication.stopping {
            next = Next::after(&stopping, &sections, &mut active, done);
            progress.imprecise(active.iter().filter(|active| **active).count(), active.len());
        }
    }
    let precise = replication.stopping.map(|_| active.iter().map(|active| !active).collect());
    Outcome { sections, precise }
}

/// Takes the steps of a round one after the other; while the cells take in the noise of one, that of the next is drawn.
///
/// The threads wait for each other once a step. The wait is short: drawing, whose tasks are long, comes first, and what is left at the end are
/// short ones.
fn run_steps<'a>(
    round: &Round,
    mut steps: impl Iterator<Item = Step<'a>>,
    (active, sections): (&[bool], &mut Sections),
    progress: &dyn Progress,
) {
    let (mut drawn, mut ahead): (Vec<LaneNoise>, Vec<LaneNoise>) = Default::default();
    let mut step: Option<Step<'a>> = None;
    loop {
        let next = steps.next();
        let draw = next.as_ref().map(|next| next.workload.draw(round, next.chunk.clone(), &mut ahead));
        let take_in = step.as_ref().map(|step| step.take_in(round, &drawn, (active, sections)));
        work_off(draw.into_iter().chain(take_in).flatten());
        progress.advanced(step.map_or(0, |step| step.completes));
        if next.is_none() {
            return;
        }
        step = next;
        mem::swap(&mut drawn, &mut ahead);
    }
}

/// Does the tasks in their order, each as soon as a thread is free.
fn work_off<'a>(tasks: impl Iterator<Item = Task<'a>> + Send) {
    tasks.par_bridge().for_each_init(Memory::default, |memory, task| task(memory));
}

/// The workloads that have anything active, and where their cells stand among all.
fn places<'a>(workloads: &[&'a dyn Workload], active: &[bool]) -> Vec<(&'a dyn Workload, Range<usize>)> {
    let mut first_cell = 0;
    let place = |workload: &&'a dyn Workload| {
        let cells = first_cell..first_cell + workload.cells();
        first_cell = cells.end;
        (*workload, cells)
    };
    workloads.iter().map(place).filter(|(_, cells)| active[cells.clone()].contains(&true)).collect()
}

/// A chunk of replicates in the cells of one workload.
struct Step<'a> {
    workload: &'a dyn Workload,
    /// Where its cells stand among all.
    cells: Range<usize>,
    chunk: Range<usize>,
    /// How many replicates are done in every workload after it that were not before.
    completes: u64,
}

impl<'a> Step<'a> {
    /// The steps of a round: every chunk through all workloads, then the next.
    fn all(round: &Round, places: &[(&'a dyn Workload, Range<usize>)]) -> impl Iterator<Item = Self> {
        round.chunks().flat_map(move |chunk| {
            places.iter().enumerate().map(move |(k, (workload, cells))| Self {
                workload: *workload,
                cells: cells.clone(),
                completes: if k + 1 == places.len() { chunk.len() as u64 } else { 0 },
                chunk: chunk.clone(),
            })
        })
    }

    /// What is left to do when its noise is drawn.
    fn take_in<'s>(
        &'s self,
        round: &'s Round,
        noise: &'s [LaneNoise],
        (active, sections): (&'s [bool], &'s mut Sections),
    ) -> Vec<Task<'s>> {
        let chunk = Chunk { round, range: self.chunk.clone(), noise };
        let sums = &mut sections.by_cell()[self.cells.clone()];
        self.workload.take_in(chunk, ActiveCells { active: &active[self.cells.clone()], sums })
    }
}

/// What all replicates left behind.
pub(super) struct Outcome {
    pub(super) sections: Sections,
    /// Whether each cell is as precise as the scenario asks; `None` where it does not ask.
    pub(super) precise: Option<Vec<bool>>,
}

/// How many replicates a study takes in all, as far as that is known before the first.
pub(super) fn forecast(replication: &Replication) -> usize {
    Next::first(replication).forecast
}

/// Up to how many replicates the next round goes, and how many the study will take in all as far as is known.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Next {
    target: usize,
    forecast: usize,
}

impl Next {
    /// Before anything is known of biases; the error of a standard deviation depends on the number of replicates alone.
    fn first(replication: &Replication) -> Self {
        let target = replication.replicates;
        let forecast = replication.stopping.map_or(target, |stopping| {
            let for_sd = stopping.sd_relative_mcse.map_or(0.0, |share| 1.0 + 0.5 / (share * share));
            target.max((for_sd.ceil() as usize).min(stopping.max_replicates))
        });
        Self { target, forecast }
    }

    /// After so many, when the cells that are precise enough have been set aside.
    fn after(stopping: &Stopping, sections: &Sections, active: &mut [bool], done: usize) -> Self {
        let mut factor: f64 = 0.0;
        for (cell, active) in active.iter_mut().enumerate() {
            if *active {
                let excess = excess(stopping, sections, cell);
                *active = excess > 1.0;
                factor = factor.max(excess);
            }
        }
        if factor <= 1.0 || done >= stopping.max_replicates {
            return Self { target: done, forecast: done };
        }
        // Errors fall as R^-1/2; at most four times as many at once, in case the estimate of the error is off.
        let wanted = |factor: f64| {
            let replicates = (done as f64 * factor).ceil() as usize;
            replicates.max(done + SECTIONS * BATCH).min(stopping.max_replicates)
        };
        Self { target: wanted((factor * factor).min(4.0)), forecast: wanted(factor * factor) }
    }
}

/// The cell's largest Monte-Carlo error over the one allowed.
fn excess(stopping: &Stopping, sections: &Sections, cell: usize) -> f64 {
    let worst = |ratio: &dyn Fn(&switchback_estimator::statistics::Performance) -> f64| {
        sections
            .cell(cell, None)
            .parameters
            .iter()
            .filter_map(|sums| sums.performance(None))
            .map(|p| ratio(&p))
            .filter(|x| x.is_finite())
            .fold(0.0, f64::max)
    };
    let bias = stopping
        .bias_mcse
        .map_or(0.0, |allowed| worst(&|p| p.bias_controlled.unwrap_or(p.bias).mcse / p.sd.value / allowed));
    let sd = stopping.sd_relative_mcse.map_or(0.0, |allowed| worst(&|p| p.sd.mcse / p.sd.value / allowed));
    bias.max(sd)
}

#[cfg(test)]
mod tests {
    use super::*;
    use switchback_estimator::statistics::ReplicateError;

    #[test]
    fn the_forecast_is_what_the_largest_error_calls_for() {
        let stopping = Stopping { bias_mcse: None, sd_relative_mcse: Some(0.01), max_replicates: 100_000 };
        let first = Next::first(&Replication { replicates: 40, stopping: Some(stopping) });
        assert_eq!(first, Next { target: 40, forecast: 5001 });
        let mut sections = Sections::new(&[1]);
        for error in (0..400).map(|r| f64::from(r % 2) - 0.5) {
            sections.by_cell()[0][0].parameters[0].push(ReplicateError {
                error,
                se: 0.5,
                first_order: None,
                second_order: 0.0,
            });
        }
        let mut active = [true];
        let next = Next::after(&stopping, &sections, &mut active, 400);
        // The relative error is (2·399)^-1/2, 3.54 times the one allowed.
        assert_eq!((next, active), (Next { target: 1600, forecast: 5013 }, [true]));
        let limited = Stopping { max_replicates: 1000, ..stopping };
        assert_eq!(Next::after(&limited, &sections, &mut active, 400), Next { target: 1000, forecast: 1000 });
        let modest = Stopping { sd_relative_mcse: Some(0.04), ..stopping };
        let done = Next::after(&modest, &sections, &mut active, 400);
        assert_eq!((done, active), (Next { target: 400, forecast: 400 }, [false]));
    }
}
