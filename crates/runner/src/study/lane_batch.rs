//! A few groups of eight replicates at a time through the cells of a family.

use super::bench::Bench;
use super::family_plan::FamilyPlan;
use super::memory::{Few, LANES_AT_ONCE};
use super::noise::LaneNoise;
use super::sections::CellSums;
use super::setting::{Contender, Setting};
use std::array;
use switchback_estimator::estimators::pulse::lanes::{LANES, Lane, LaneFit, LaneSample, LaneStep};
use switchback_estimator::estimators::pulse::{PulseData, StepMean};
use switchback_estimator::simulation::{LaneCross, LaneGroupedNoise};
use switchback_estimator::statistics::{LaneErrors, LaneSums};

/// One method at one noise level.
pub(super) struct Cell<'a> {
    pub(super) contender: &'a Contender,
    sums: &'a mut [CellSums],
    /// The section of the replicates that are not in the sums yet.
    section: usize,
}

impl<'a> Cell<'a> {
    pub(super) fn new(contender: &'a Contender, sums: &'a mut [CellSums]) -> Self {
        Self { contender, sums, section: 0 }
    }

    /// Puts the running sums where they belong.
    pub(super) fn settle(&mut self, running: &mut LaneSums) {
        running.drain_into(&mut self.sums[self.section].parameters);
    }

    /// The sums of a section; the running ones belong there from now on.
    fn enter(&mut self, section: usize, running: &mut LaneSums) -> &mut CellSums {
        if section != self.section {
            self.settle(running);
            self.section = section;
        }
        &mut self.sums[section]
    }
}

/// Where a family stands.
pub(super) struct Place<'a> {
    pub(super) plan: &'a FamilyPlan,
    pub(super) bench: &'a Bench,
    /// Index of its period.
    pub(super) period: usize,
}

impl Place<'_> {
    /// The noise of an experiment that any method looks at.
    fn pulses<'n>(&self, noise: &'n LaneNoise, k: usize) -> Option<&'n LaneGroupedNoise> {
        Some(&noise.pulses[k].get(self.plan.checkpoint)?[self.period])
    }

    /// What the responses have in common with the noise.
    pub(super) fn cross(&self, noise: &[LaneNoise], crosses: &mut Vec<[LaneCross; 2]>) {
        crosses.resize_with(noise.len(), Default::default);
        for (noise, crosses) in noise.iter().zip(crosses) {
            for (k, cross) in crosses.iter_mut().enumerate() {
                if let Some(pulses) = self.pulses(noise, k) {
                    self.plan.superpositions[k].cross(pulses, cross);
                }
            }
        }
    }

    /// The data of a few groups at a noise level.
    pub(super) fn superpose(
        &self,
        setting: &Setting,
        (noise, crosses): (&[LaneNoise], &[[LaneCross; 2]]),
        few: &mut Few,
    ) {
        for (i, (noise, crosses)) in noise.iter().zip(crosses).enumerate() {
            for (k, cross) in crosses.iter().enumerate() {
                let Some(pulses) = self.pulses(noise, k) else { continue };
                self.plan.superpositions[k].at((pulses, cross), setting.sigma, &mut few.statistics[i][k]);
                let unit = noise.steps[k].get(self.plan.checkpoint).copied().unwrap_or(Lane::ZERO);
                let mean = unit * setting.sigma + Lane::splat(setting.bench.satellite_output(k));
                few.steps[i][k] = LaneStep { mean, samples: self.plan.samples as f64 };
            }
        }
    }

    /// Adds one method's errors to the sums of a cell, the `cell_index`-th of its level.
    pub(super) fn estimate(
        &self,
        cell: &mut Cell<'_>,
        noise: &[LaneNoise],
        few: &mut Few,
        cell_index: usize,
    ) {
        let Few { statistics, steps, fits, terms, sums } = few;
        let (contender, running) = (cell.contender, &mut sums[cell_index]);
        let experiments = contender.kind.experiments();
        let (first, last) = (experiments[0], experiments[experiments.len() - 1]);
        let parts = statistics.each_ref().map(|both| both.each_ref());
        let samples: [LaneSample<'_>; LANES_AT_ONCE] = array::from_fn(|i| LaneSample {
            parts: &parts[i][first..=last],
            step: contender.kind.needs_step().then_some(steps[i][first]),
        });
        let samples = &samples[..noise.len()];
        contender.lanes.fit(samples, fits);
        contender.control.terms(samples, &contender.means[self.plan.checkpoint], terms);
        let errors: [LaneErrors<'_>; LANES_AT_ONCE] = array::from_fn(|i| LaneErrors {
            values: &fits[i].values,
            variances: &fits[i].variances,
            first_order: &terms[i].first,
            second_order: &terms[i].second,
        });
        let section = noise[0].section();
        let plain =
            |(noise, fit): (&LaneNoise, &LaneFit)| noise.section() == section && fit.sound == [true; LANES];
        match section {
            Some(section) if noise.iter().zip(&*fits).all(plain) => {
                cell.enter(section, running).replicates += noise.len() * LANES;
                running.add_all(&contender.truth, &errors[..noise.len()]);
            }
            _ => {
                for (i, noise) in noise.iter().enumerate() {
                    let alone = |l: usize, sums: &mut CellSums| {
                        let steps = steps[i].map(|s| StepMean { mean: s.mean.0[l], samples: s.samples });
                        self.estimate_alone(
                            &self.bench.replicate(&statistics[i], l),
                            steps,
                            (contender, noise.first + l as u32),
                            sums,
                        );
                    };
                    add(cell, (&noise.sections, &fits[i].sound), (errors[i], running), alone);
                }
            }
        }
    }

    /// A replicate that the lanes could not solve, or its failure.
    fn estimate_alone(
        &self,
        data: &[PulseData; 2],
        steps: [StepMean; 2],
        (contender, replicate): (&Contender, u32),
        sums: &mut CellSums,
    ) {
        contender.kind.with_input(data, steps, |method| match method.fit() {
            Ok(fit) => {
                let errors = fit.parameters().zip(&contender.truth).map(|(x, truth)| (x.value - truth, x.se));
                sums.push(errors, &contender.terms(self.plan.checkpoint, &method));
            }
            Err(error) => sums.fail(replicate, error.to_string()),
        });
    }
}

/// Adds the errors of eight replicates that may belong to several sections; those without estimates go to `alone`.
fn add(
    cell: &mut Cell<'_>,
    (sections, sound): (&[usize], &[bool; LANES]),
    (errors, running): (LaneErrors<'_>, &mut LaneSums),
    alone: impl Fn(usize, &mut CellSums),
) {
    let truth = &cell.contender.truth;
    // Replicates that follow each other in a section are added in one go.
    let mut next = 0;
    for run in sections.chunk_by(|s, t| s == t) {
        let sums = cell.enter(run[0], running);
        sums.replicates += run.len();
        let end = next + run.len();
        while next < end {
            let solved = (next..end).take_while(|l| sound[*l]).count();
            if solved > 0 {
                running.add(truth, errors, next..next + solved);
                next += solved;
            } else {
                alone(next, sums);
                next += 1;
            }
        }
    }
}
