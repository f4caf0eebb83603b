//! Running the replicates, in parallel and reproducibly.

use super::cell::{CellSpec, Workload};
use super::sections::{CellSums, SECTIONS, Sections};
use crate::scenario::{Scenario, Stopping};
use rayon::prelude::*;
use std::ops::Range;

/// Replicates of one noise pass: a whole number of lanes at every width.
pub(super) const BATCH: usize = 16;

/// Replicates whose noise is held at once.
const CHUNK: usize = 8 * BATCH;

/// Told how the work goes on; called from several threads.
pub trait Progress: Sync {
    /// So many replicates of the study are to be run, as far as is known now.
    fn planned(&self, replicates: u64);
    /// So many more are done.
    fn advanced(&self, replicates: u64);
}

/// Runs replicates until the scenario has enough of them.
///
/// Replicates are numbered; number `r` sees the same noise whatever else is run. Each round gives every section a contiguous range of them.
pub(super) fn run(
    scenario: &Scenario,
    workloads: &[&dyn Workload],
    specs: &[CellSpec],
    progress: &dyn Progress,
) -> Sections {
    let parameters: Vec<usize> = specs.iter().map(|s| s.parameters.len()).collect();
    let mut sections = Sections::new(&parameters);
    let mut active = vec![true; parameters.len()];
    let replication = scenario.replication();
    let mut done = 0;
    let mut target = replication.replicates;
    while done < target {
        progress.planned(target as u64);
        let round = Round { seed: scenario.seed(), range: done..target };
        for chunk in round.chunks() {
            let mut first_cell = 0;
            for workload in workloads {
                let cells = first_cell..first_cell + workload.cells();
                first_cell = cells.end;
                if active[cells.clone()].contains(&true) {
                    workload.run(
                        &round,
                        chunk.clone(),
                        &active[cells.clone()],
                        &mut sections.by_cell()[cells],
                    );
                }
            }
            progress.advanced((chunk.end - chunk.start) as u64);
        }
        done = target;
        if let Some(stopping) = replication.stopping {
            target = next_target(&stopping, &sections, &mut active, done);
        }
    }
    sections
}

/// The replicates between two looks at the stopping rule.
#[derive(Debug, Clone)]
pub(super) struct Round {
    pub(super) seed: u64,
    pub(super) range: Range<usize>,
}

impl Round {
    /// Its replicates in runs of a few, whose noise is held at once.
    fn chunks(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        self.range.clone().step_by(CHUNK).map(|start| start..self.range.end.min(start + CHUNK))
    }

    /// The section that a replicate belongs to: sections are contiguous and of (nearly) equal size.
    pub(super) fn section(&self, replicate: usize) -> usize {
        ((replicate - self.range.start + 1) * SECTIONS).div_ceil(self.range.len()) - 1
    }
}

/// Runs the replicates `chunk` one by one in parallel: each section's part is summed on its own, and the parts are added in order.
pub(super) fn by_sections(
    round: &Round,
    chunk: Range<usize>,
    cells: &mut [Vec<CellSums>],
    replicate: impl Fn(u32, &mut [CellSums]) + Sync,
) {
    let replicates: Vec<usize> = chunk.collect();
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

/// Up to how many replicates the next round goes, after the cells that are precise enough have been set aside.
fn next_target(stopping: &Stopping, sections: &Sections, active: &mut [bool], done: usize) -> usize {
    let mut factor: f64 = 0.0;
    for (cell, active) in active.iter_mut().enumerate() {
        if *active {
            let excess = excess(stopping, sections, cell);
            *active = excess > 1.0;
            factor = factor.max(excess);
        }
    }
    if factor <= 1.0 || done >= stopping.max_replicates {
        return done;
    }
    // Errors fall as R^-1/2; at most four times as many at once, in case the estimate of the error is off.
    let wanted = (done as f64 * (factor * factor).min(4.0)).ceil() as usize;
    wanted.max(done + SECTIONS * BATCH).min(stopping.max_replicates)
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
