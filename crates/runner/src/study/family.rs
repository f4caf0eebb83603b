//! Cells of one border, m and N: they share all but the noise level and the method.

use super::bench::Bench;
use super::moments::LaneNoise;
use super::sections::CellSums;
use super::world::{Contender, Setting};
use std::array;
use std::ops::Range;
use switchback_estimator::estimators::pulse::lanes::{
    LANES, Lane, LaneFit, LaneSample, LaneStatistics, LaneStep, LaneTerms,
};
use switchback_estimator::estimators::pulse::{PulseData, StepMean};
use switchback_estimator::simulation::{LaneCross, LaneGroupedNoise, LaneSuperposition};
use switchback_estimator::statistics::{LaneErrors, LaneSums};

/// What the cells of one border, m and N have in common.
#[derive(Debug, Clone)]
pub(super) struct FamilyPlan {
    /// Their noise levels, among the settings of the world.
    settings: Range<usize>,
    /// Index of the number of samples.
    checkpoint: usize,
    samples: usize,
    superpositions: [LaneSuperposition; 2],
}

impl FamilyPlan {
    /// The families of some settings, the noise levels of a border and m next to each other, at these numbers of samples.
    pub(super) fn all(settings: &[Setting], checkpoints: &[usize]) -> Vec<Self> {
        let same = |s: &Setting, t: &Setting| (s.border, s.bench.points) == (t.border, t.bench.points);
        let mut families = Vec::new();
        let mut first = 0;
        for levels in settings.chunk_by(same) {
            let settings = first..first + levels.len();
            first = settings.end;
            families.extend(checkpoints.iter().enumerate().map(|(checkpoint, &samples)| Self {
                settings: settings.clone(),
                checkpoint,
                samples,
                superpositions: levels[0].bench.superpositions(samples),
            }));
        }
        families
    }
}

/// The cells of one border, m and N, with their sums.
pub(super) struct Family<'a> {
    plan: &'a FamilyPlan,
    bench: &'a Bench,
    period: usize,
    levels: Vec<NoiseLevel<'a>>,
}

/// The cells of a family at one noise level, a method each.
struct NoiseLevel<'a> {
    setting: &'a Setting,
    /// The active ones.
    cells: Vec<Cell<'a>>,
}

impl<'a> Family<'a> {
    /// The families that have anything active; `active` and `cells` are in the order of the world's cells.
    pub(super) fn all(
        plans: &'a [FamilyPlan],
        settings: &'a [Setting],
        mut active: &'a [bool],
        mut cells: &'a mut [Vec<CellSums>],
    ) -> Vec<Self> {
        let mut families = Vec::with_capacity(plans.len());
        for plans in plans.chunk_by(|p, q| p.settings == q.settings) {
            let settings = &settings[plans[0].settings.clone()];
            let first = families.len();
            families.extend(plans.iter().map(|plan| Self {
                plan,
                bench: &settings[0].bench,
                period: settings[0].period,
                levels: Vec::with_capacity(settings.len()),
            }));
            for setting in settings {
                for family in &mut families[first..] {
                    let methods = setting.methods.len();
                    let (own, rest) = cells.split_at_mut(methods);
                    cells = rest;
                    let contenders = setting.methods.iter().zip(own).zip(&active[..methods]);
                    let cells: Vec<Cell<'a>> = contenders
                        .filter(|(_, active)| **active)
                        .map(|((contender, sums), _)| Cell { contender, sums, section: 0 })
                        .collect();
                    if !cells.is_empty() {
                        family.levels.push(NoiseLevel { setting, cells });
                    }
                    active = &active[methods..];
                }
            }
        }
        families.retain(|family| !family.levels.is_empty());
        // Those of one m and N take in the same noise: next to each other, they find it in the cache.
        families.sort_by_key(|family| (family.period, family.plan.checkpoint));
        families
    }

    /// Estimates every active cell from the noise of some replicates of a round, in order.
    pub(super) fn run(self, noise: &[LaneNoise], memory: &mut Memory) {
        let place = Place { plan: self.plan, bench: self.bench, period: self.period };
        let Memory { crosses, few } = memory;
        place.cross(noise, crosses);
        few.shape(&self.plan.superpositions);
        for NoiseLevel { setting, mut cells } in self.levels {
            few.sums.resize_with(cells.len(), LaneSums::default);
            for (sums, cell) in few.sums.iter_mut().zip(&cells) {
                sums.reset(cell.contender.parameters.len());
            }
            for (noise, crosses) in noise.chunks(ABREAST).zip(crosses.chunks(ABREAST)) {
                place.superpose(setting, (noise, crosses), few);
                for (k, cell) in cells.iter_mut().enumerate() {
                    place.estimate(cell, noise, few, k);
                }
            }
            cells.iter_mut().zip(&mut few.sums).for_each(|(cell, running)| cell.settle(running));
        }
    }
}

/// One method at one noise level.
struct Cell<'a> {
    contender: &'a Contender,
    sums: &'a mut [CellSums],
    /// The section of the replicates that are not in the sums yet.
    section: usize,
}

impl Cell<'_> {
    /// Puts the running sums where they belong.
    fn settle(&mut self, running: &mut LaneSums) {
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

/// Groups of eight replicates that a cell takes in before the next: so many statistics, and one cell's sums, stay in the cache.
const ABREAST: usize = 4;

/// What one family leaves to the next: memory.
#[derive(Default)]
pub(super) struct Memory {
    /// One a group of eight replicates.
    crosses: Vec<[LaneCross; 2]>,
    few: Few,
}

/// A few groups of eight replicates at one noise level.
#[derive(Default)]
struct Few {
    statistics: [[LaneStatistics; 2]; ABREAST],
    steps: [[LaneStep; 2]; ABREAST],
    fits: [LaneFit; ABREAST],
    terms: [LaneTerms; ABREAST],
    /// Running sums of the level's cells.
    sums: Vec<LaneSums>,
}

impl Few {
    fn shape(&mut self, superpositions: &[LaneSuperposition; 2]) {
        for statistics in &mut self.statistics {
            statistics.iter_mut().zip(superpositions).for_each(|(s, from)| from.shape(s));
        }
    }
}

/// Where a family stands.
struct Place<'a> {
    plan: &'a FamilyPlan,
    bench: &'a Bench,
    period: usize,
}

impl Place<'_> {
    /// The noise of an experiment that any method looks at.
    fn pulses<'n>(&self, noise: &'n LaneNoise, k: usize) -> Option<&'n LaneGroupedNoise> {
        Some(&noise.pulses[k].get(self.plan.checkpoint)?[self.period])
    }

    /// What the responses have in common with the noise.
    fn cross(&self, noise: &[LaneNoise], crosses: &mut Vec<[LaneCross; 2]>) {
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
    fn superpose(
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
    fn estimate(&self, cell: &mut Cell<'_>, noise: &[LaneNoise], few: &mut Few, cell_index: usize) {
        let Few { statistics, steps, fits, terms, sums } = few;
        let (contender, running) = (cell.contender, &mut sums[cell_index]);
        let experiments = contender.kind.experiments();
        let (first, last) = (experiments[0], experiments[experiments.len() - 1]);
        let parts = statistics.each_ref().map(|both| both.each_ref());
        let samples: [LaneSample<'_>; ABREAST] = array::from_fn(|i| LaneSample {
            parts: &parts[i][first..=last],
            step: contender.kind.needs_step().then_some(steps[i][first]),
        });
        let samples = &samples[..noise.len()];
        contender.lanes.fit(samples, fits);
        contender.control.terms(samples, &contender.means[self.plan.checkpoint], terms);
        let errors: [LaneErrors<'_>; ABREAST] = array::from_fn(|i| LaneErrors {
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
