//! Cells of one border, m and N: they share all but the noise level and the method.

use super::bench::Bench;
use super::execute::Round;
use super::moments::LaneNoise;
use super::sections::CellSums;
use super::world::{Contender, Setting};
use std::array;
use std::ops::Range;
use switchback_estimator::estimators::pulse::StepMean;
use switchback_estimator::estimators::pulse::lanes::{
    LANES, Lane, LaneFit, LaneSample, LaneStatistics, LaneStep, LaneTerms,
};
use switchback_estimator::simulation::{LaneCross, LaneSuperposition};
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
                        .map(|((contender, sums), _)| Cell::new(contender, sums))
                        .collect();
                    if !cells.is_empty() {
                        family.levels.push(NoiseLevel { setting, cells });
                    }
                    active = &active[methods..];
                }
            }
        }
        families.retain(|family| !family.levels.is_empty());
        families
    }

    /// Estimates every active cell from the noise of some replicates of a round, in order.
    pub(super) fn run(mut self, noise: &[LaneNoise], round: &Round) {
        let FamilyPlan { checkpoint, samples, ref superpositions, .. } = *self.plan;
        let mut abreast: [Lanes; ABREAST] = array::from_fn(|_| Lanes::new(superpositions));
        let mut memory = Memory::default();
        for noise in noise.chunks(ABREAST) {
            let all = &mut abreast[..noise.len()];
            for (lanes, noise) in all.iter_mut().zip(noise) {
                lanes.load(superpositions, noise, round, (checkpoint, self.period));
            }
            for NoiseLevel { setting, cells } in &mut self.levels {
                for (lanes, noise) in all.iter_mut().zip(noise) {
                    lanes.superpose(superpositions, setting, noise, (checkpoint, self.period, samples));
                }
                let few = Few { all, bench: self.bench, checkpoint };
                cells.iter_mut().for_each(|cell| few.estimate(cell, &mut memory));
            }
        }
        self.levels.iter_mut().flat_map(|level| &mut level.cells).for_each(Cell::settle);
    }
}

/// One method at one noise level.
struct Cell<'a> {
    contender: &'a Contender,
    sums: &'a mut [CellSums],
    /// Replicates of section `section` that are not in its sums yet.
    running: LaneSums,
    section: usize,
}

impl<'a> Cell<'a> {
    fn new(contender: &'a Contender, sums: &'a mut [CellSums]) -> Self {
        Self { contender, sums, running: LaneSums::new(contender.parameters.len()), section: 0 }
    }

    /// Puts the running sums where they belong.
    fn settle(&mut self) {
        self.running.drain_into(&mut self.sums[self.section].parameters);
    }

    /// The sums of a section, and the running ones that belong there.
    fn enter(&mut self, section: usize) -> (&mut CellSums, &mut LaneSums) {
        if section != self.section {
            self.settle();
            self.section = section;
        }
        (&mut self.sums[section], &mut self.running)
    }
}

/// Groups of eight replicates that a cell takes in before the next: so many statistics, and one cell's sums, stay in the cache.
const ABREAST: usize = 4;

/// Eight replicates at one noise level.
struct Lanes {
    first: u32,
    /// Sections of the replicates, in order.
    sections: Vec<usize>,
    /// Whether there is noise of the experiment: whether any method looks at it.
    used: [bool; 2],
    cross: [LaneCross; 2],
    statistics: [LaneStatistics; 2],
    steps: [LaneStep; 2],
}

impl Lanes {
    fn new(superpositions: &[LaneSuperposition; 2]) -> Self {
        Self {
            first: 0,
            sections: Vec::with_capacity(LANES),
            used: [false; 2],
            cross: [LaneCross::default(), LaneCross::default()],
            statistics: [0, 1].map(|k| superpositions[k].statistics()),
            steps: [LaneStep { mean: Lane::ZERO, samples: 0.0 }; 2],
        }
    }

    /// Takes in the noise of other replicates.
    fn load(
        &mut self,
        superpositions: &[LaneSuperposition; 2],
        noise: &LaneNoise,
        round: &Round,
        (checkpoint, period): (usize, usize),
    ) {
        self.first = noise.first;
        self.sections.clear();
        self.sections.extend((0..noise.live).map(|l| round.section(noise.first as usize + l)));
        for k in 0..2 {
            self.used[k] = !noise.pulses[k].is_empty();
            if self.used[k] {
                superpositions[k].cross(&noise.pulses[k][checkpoint][period], &mut self.cross[k]);
            }
        }
    }

    fn superpose(
        &mut self,
        superpositions: &[LaneSuperposition; 2],
        setting: &Setting,
        noise: &LaneNoise,
        (checkpoint, period, samples): (usize, usize, usize),
    ) {
        for k in (0..2).filter(|k| self.used[*k]) {
            let pulses = &noise.pulses[k][checkpoint][period];
            superpositions[k].at((pulses, &self.cross[k]), setting.sigma, &mut self.statistics[k]);
            let unit = noise.steps[k].get(checkpoint).copied().unwrap_or(Lane::ZERO);
            let mean = unit * setting.sigma + Lane::splat(setting.bench.satellite_output(k));
            self.steps[k] = LaneStep { mean, samples: samples as f64 };
        }
    }

    /// The section of all eight, if they are eight of one section.
    fn section(&self) -> Option<usize> {
        let (first, last) = (self.sections.first()?, self.sections.last()?);
        (self.sections.len() == LANES && first == last).then_some(*first)
    }
}

/// What one cell leaves to the next.
#[derive(Default)]
struct Memory {
    fits: [LaneFit; ABREAST],
    terms: [LaneTerms; ABREAST],
}

/// A few groups of eight replicates at one noise level.
struct Few<'a> {
    all: &'a [Lanes],
    bench: &'a Bench,
    /// Index of the number of samples.
    checkpoint: usize,
}

impl Few<'_> {
    /// Adds one method's errors to the sums of a cell.
    fn estimate(&self, cell: &mut Cell<'_>, memory: &mut Memory) {
        let Memory { fits, terms } = memory;
        let (all, contender) = (self.all, cell.contender);
        let experiments = contender.kind.experiments();
        // What is beyond the groups at hand repeats the last and is left out.
        let at = |k: usize| &all[k.min(all.len() - 1)];
        let parts: [[&LaneStatistics; 2]; ABREAST] = array::from_fn(|k| at(k).statistics.each_ref());
        let samples: [LaneSample<'_>; ABREAST] = array::from_fn(|k| LaneSample {
            parts: &parts[k][experiments[0]..=experiments[experiments.len() - 1]],
            step: contender.kind.needs_step().then(|| at(k).steps[experiments[0]]),
        });
        let samples = &samples[..all.len()];
        contender.lanes.fit(samples, fits);
        contender.control.terms(samples, &contender.means[self.checkpoint], terms);
        let errors: [LaneErrors<'_>; ABREAST] = array::from_fn(|k| LaneErrors {
            values: &fits[k].values,
            variances: &fits[k].variances,
            first_order: &terms[k].first,
            second_order: &terms[k].second,
        });
        let section = all[0].section();
        let plain =
            |(lanes, fit): (&Lanes, &LaneFit)| lanes.section() == section && fit.sound == [true; LANES];
        match section {
            Some(section) if all.iter().zip(&*fits).all(plain) => {
                let (sums, running) = cell.enter(section);
                sums.replicates += all.len() * LANES;
                running.add_all(&contender.truth, &errors[..all.len()]);
            }
            _ => {
                for ((lanes, fit), errors) in all.iter().zip(&*fits).zip(errors) {
                    self.add(cell, lanes, fit, errors);
                }
            }
        }
    }

    /// Adds the errors of eight replicates that may belong to several sections, or have no estimates.
    fn add(&self, cell: &mut Cell<'_>, lanes: &Lanes, fit: &LaneFit, errors: LaneErrors<'_>) {
        let contender = cell.contender;
        // Replicates that follow each other in a section are added in one go.
        let mut next = 0;
        for run in lanes.sections.chunk_by(|s, t| s == t) {
            let (sums, running) = cell.enter(run[0]);
            sums.replicates += run.len();
            let end = next + run.len();
            while next < end {
                let sound = (next..end).take_while(|l| fit.sound[*l]).count();
                if sound > 0 {
                    running.add(&contender.truth, errors, next..next + sound);
                    next += sound;
                } else {
                    self.estimate_alone(lanes, next, contender, sums);
                    next += 1;
                }
            }
        }
    }

    /// A replicate that the lanes could not solve, or its failure.
    fn estimate_alone(&self, lanes: &Lanes, l: usize, contender: &Contender, sums: &mut CellSums) {
        let steps = lanes.steps.map(|s| StepMean { mean: s.mean.0[l], samples: s.samples });
        contender.kind.with_input(&self.bench.replicate(&lanes.statistics, l), steps, |method| match method
            .fit()
        {
            Ok(fit) => {
                let errors = fit.parameters().zip(&contender.truth).map(|(x, truth)| (x.value - truth, x.se));
                sums.push(errors, &contender.terms(self.checkpoint, &method));
            }
            Err(error) => sums.fail(lanes.first + l as u32, error.to_string()),
        });
    }
}
