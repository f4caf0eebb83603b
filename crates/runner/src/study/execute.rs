//! Running the replicates, in parallel and reproducibly.

use super::cell::{CellSpec, Workload};
use super::moments::{ReplicateNoise, draw};
use super::sections::{CellSums, SECTIONS, Sections};
use super::world::{Contender, Setting, World};
use crate::scenario::{Scenario, Stopping};
use rayon::prelude::*;
use std::ops::Range;
use switchback_estimator::estimators::pulse::{PulseData, PulseFitError, StepMean};
use switchback_estimator::statistics::ReplicateError;

/// Replicates whose noise is held at once: a whole number of lanes at every width.
const BATCH: u32 = 16;

/// Told how the work goes on; called from several threads.
pub trait Progress: Sync {
    /// So many replicates of the study are to be run, as far as is known now.
    fn planned(&self, replicates: u64);
    /// So many more are done.
    fn advanced(&self, replicates: u64);
}

/// Runs replicates until the scenario has enough of them.
///
/// Replicates are numbered; number `r` sees the same noise whatever else is run. Each round gives every section a contiguous range of them, so
/// the sums of a section, added in order, depend on nothing but the numbers.
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
        round(scenario.seed(), workloads, done..target, &active, &mut sections, progress);
        done = target;
        if let Some(stopping) = replication.stopping {
            target = next_target(&stopping, &sections, &mut active, done);
        }
    }
    sections
}

/// One round: the replicates of `range`, divided over the sections.
fn round(
    seed: u64,
    workloads: &[&dyn Workload],
    range: Range<usize>,
    active: &[bool],
    sections: &mut Sections,
    progress: &dyn Progress,
) {
    let cut = |k: usize| (range.start + range.len() * k / SECTIONS) as u32;
    sections.by_section().par_iter_mut().enumerate().for_each(|(section, sums)| {
        let mut start = cut(section);
        let end = cut(section + 1);
        while start < end {
            let batch = start..end.min(start + BATCH);
            let mut first_cell = 0;
            for workload in workloads {
                let range = first_cell..first_cell + workload.cells();
                first_cell = range.end;
                if active[range.clone()].iter().any(|a| *a) {
                    workload.run(seed, batch.clone(), &active[range.clone()], &mut sums[range]);
                }
            }
            progress.advanced(u64::from(batch.end - batch.start));
            start = batch.end;
        }
    });
}

impl Workload for World {
    fn cells(&self) -> usize {
        World::cells(self).count()
    }

    fn run(&self, seed: u64, replicates: Range<u32>, active: &[bool], sums: &mut [CellSums]) {
        run_batch(self, seed, replicates, active, sums);
    }
}

/// Some replicates of one world.
fn run_batch(world: &World, seed: u64, batch: Range<u32>, active: &[bool], sums: &mut [CellSums]) {
    for (replicate, noise) in batch.clone().zip(draw(world, seed, batch)) {
        let mut cell = 0;
        for setting in &world.settings {
            for checkpoint in 0..world.pulses.checkpoints.len() {
                let cells = cell..cell + setting.methods.len();
                cell = cells.end;
                if active[cells.clone()].iter().any(|a| *a) {
                    let sample = Sample::new(world, setting, checkpoint, &noise);
                    for ((contender, sums), active) in
                        setting.methods.iter().zip(&mut sums[cells.clone()]).zip(&active[cells])
                    {
                        if *active {
                            sample.estimate(contender, replicate, sums);
                        }
                    }
                }
            }
        }
    }
}

/// The data of one replicate in one setting, at one number of samples.
pub(super) struct Sample {
    data: [PulseData; 2],
    steps: [StepMean; 2],
}

impl Sample {
    pub(super) fn new(world: &World, setting: &Setting, checkpoint: usize, noise: &ReplicateNoise) -> Self {
        let samples = world.pulses.checkpoints[checkpoint] as f64;
        Self {
            data: setting.bench.data(setting.sigma, noise.pulses(checkpoint, setting.period)),
            steps: setting.bench.steps(setting.sigma, noise.step_means(checkpoint), samples),
        }
    }

    /// The values of a method's parameters.
    pub(super) fn estimates(&self, contender: &Contender) -> Result<Vec<f64>, PulseFitError> {
        let fit = contender.kind.with_input(&self.data, self.steps, |method| method.fit())?;
        Ok(fit.parameters().map(|p| p.value).collect())
    }

    fn estimate(&self, contender: &Contender, replicate: u32, sums: &mut CellSums) {
        sums.replicates += 1;
        contender.kind.with_input(&self.data, self.steps, |method| match method.fit() {
            Ok(fit) => {
                let first_order = contender.limit.first_order(&method);
                for (((estimated, first), truth), sums) in
                    fit.parameters().zip(first_order).zip(&contender.truth).zip(&mut sums.parameters)
                {
                    let error = estimated.value - truth;
                    sums.push(ReplicateError { error, se: estimated.se, first_order: Some(first) });
                }
            }
            Err(error) => sums.fail(replicate, error.to_string()),
        });
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
    wanted
        .clamp(done + SECTIONS * BATCH as usize, stopping.max_replicates.max(done + 1))
        .min(stopping.max_replicates)
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
