//! The engine that takes nothing for granted: every cell is simulated sample by sample and fitted by dense least squares.
//!
//! The difference equation is run with the noise in it, every row of the regression is written out, and the rows are solved by QR: no closed-form
//! response, no superposition, no sufficient statistics but for the control variate. It sees the noise of the other engine, replicate by
//! replicate, so both give the same estimates to rounding; it is some thousand times slower.

mod fit;
mod folds;
mod qr;
mod record;
mod regression;
mod solved;

pub(super) use record::{OpenNoise, OpenRecord, disturbed};

use super::cell::ActiveCells;
use super::cell_design::{CellDesign, MethodCase};
use super::noise_group::NoiseGroup;
use super::sections::{Outcome, SectionSums};
use super::workload::{Chunk, Task, Workload, one_by_one};
use crate::scenario::{Case, Scenario};
use regression::Experiment;
use switchback_identify::pulse::{GroupedStatistics, PulseData, PulseFitError, PulseMethod, StepMean};

/// A noise group whose cells are simulated one by one.
pub(super) struct DirectGroup<'a> {
    group: &'a NoiseGroup,
    scenario: &'a Scenario,
}

impl<'a> DirectGroup<'a> {
    pub(super) fn new(group: &'a NoiseGroup, scenario: &'a Scenario) -> Self {
        Self { group, scenario }
    }

    fn replicate(&self, seed: u64, replicate: u32, active: &[bool], sums: &mut [SectionSums]) {
        let noise = OpenNoise::draw(self.group, seed, replicate);
        let mut cells = active.iter().zip(sums);
        for cell_design in &self.group.cell_designs {
            let case = &self.scenario.cases()[cell_design.case];
            let border = &case.borders[cell_design.border];
            let records =
                |sigma| [0, 1].map(|k| noise.record(self.group, (case, border), (cell_design, sigma), k));
            let simulated = |sigma| Simulated::new(case, cell_design, &records(sigma));
            let (own, mirrored) = (simulated(cell_design.sigma), simulated(-cell_design.sigma));
            for (checkpoint, &samples) in self.group.noise.pulses.checkpoints.iter().enumerate() {
                let length = (checkpoint, samples);
                for method_case in &cell_design.methods {
                    let Some((active, sums)) = cells.next() else { return };
                    if !*active {
                        continue;
                    }
                    sums.runs.replicates += 1;
                    match own.estimate(method_case, length) {
                        Ok(own) => {
                            let partner = method_case
                                .is_paired()
                                .then(|| mirrored.estimate(method_case, length).ok())
                                .flatten();
                            let variances = method_case.expansions[checkpoint].variances.as_deref();
                            sums.push_pair(&own, partner.as_ref(), variances);
                        }
                        Err(error) => sums.runs.fail(replicate, error.to_string()),
                    }
                }
            }
        }
    }
}

impl Workload for DirectGroup<'_> {
    fn cells(&self) -> usize {
        self.group.cells().count()
    }

    fn take_in<'a>(&'a self, chunk: Chunk<'a>, cells: ActiveCells<'a>) -> Vec<Task<'a>> {
        one_by_one(chunk, cells, |seed, replicate, active, sums| {
            self.replicate(seed, replicate, active, sums)
        })
    }
}

/// Both experiments of one setting in one replicate.
struct Simulated {
    order: usize,
    experiments: [Experiment; 2],
    /// Mean outputs of the step experiments, one a number of samples of the noise group.
    step_means: [Vec<f64>; 2],
}

impl Simulated {
    fn new(case: &Case, cell_design: &CellDesign, records: &[OpenRecord; 2]) -> Self {
        let order = case.order;
        let period = cell_design.setup.period();
        let experiment = |k: usize| {
            let (record, levels) = (&records[k], cell_design.setup.levels(k).to_vec());
            let level = |v: f64| levels.iter().position(|l| *l == v);
            let seen = |t: usize| (1..=order).find_map(|lag| Some((level(record.v[t - lag])?, lag)));
            Experiment {
                branch: cell_design.setup.branch(k),
                satellite: cell_design.setup.satellite(k),
                before: record.y[..record.lead - order].to_vec(),
                y: record.y[record.lead - order..].to_vec(),
                period,
                seen: (record.lead..record.v.len()).map(seen).collect(),
                levels,
            }
        };
        let step_means = records.each_ref().map(|record| record.step_means.clone());
        Self { order, experiments: [0, 1].map(experiment), step_means }
    }

    fn estimate(
        &self,
        method_case: &MethodCase,
        (checkpoint, samples): (usize, usize),
    ) -> Result<Outcome, PulseFitError> {
        let steps = self
            .step_means
            .each_ref()
            .map(|means| StepMean { mean: means[checkpoint], samples: samples as f64 });
        let estimates = fit::fit(method_case.kind, self.order, &self.experiments, steps, samples)?;
        let data = [0, 1].map(|k| {
            let data = self.statistics(k, samples);
            let folds =
                method_case.kind.folds().then(|| folds::means(&self.experiments[k], self.order, samples));
            data.with_folds(folds)
        });
        let outcome =
            |method: PulseMethod<'_>| method_case.outcome_of(checkpoint, &method, estimates.into_iter());
        Ok(method_case.kind.with_input(&data, steps, outcome))
    }

    /// What the control variate is made of.
    fn statistics(&self, k: usize, samples: usize) -> PulseData {
        let Experiment { branch, levels, satellite, y, seen, .. } = &self.experiments[k];
        let mut statistics = GroupedStatistics::new(self.order, 1 + levels.len() * self.order);
        for (window, seen) in y.windows(self.order + 1).zip(seen).take(samples) {
            let group = seen.map_or(0, |(level, lag)| PulseData::group(self.order, level, lag));
            let latest_first: Vec<f64> = window.iter().rev().copied().collect();
            statistics.push(group, &latest_first);
        }
        PulseData::from_statistics(*branch, levels.clone(), *satellite, statistics)
    }
}
