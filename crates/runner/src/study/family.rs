//! Cells of one border, m and N: they share all but the noise level and the method.

use super::bench::Bench;
use super::execute::Round;
use super::moments::LaneNoise;
use super::sections::CellSums;
use super::world::{Contender, Setting, World};
use switchback_estimator::estimators::pulse::StepMean;
use switchback_estimator::estimators::pulse::lanes::{
    LANES, Lane, LaneFit, LaneStatistics, LaneStep, LaneTerms,
};
use switchback_estimator::simulation::LaneSuperposition;
use switchback_estimator::statistics::{LaneErrors, LaneSums};

/// The cells of one border, m and N, with their sums.
pub(super) struct Family<'a> {
    checkpoint: usize,
    samples: usize,
    period: usize,
    bench: &'a Bench,
    levels: Vec<NoiseLevel<'a>>,
}

/// The cells of a family at one noise level, a method each.
struct NoiseLevel<'a> {
    setting: &'a Setting,
    /// The active ones.
    cells: Vec<Cell<'a>>,
}

impl<'a> Family<'a> {
    /// The families of a world; `active` and `cells` are in the order of its cells.
    pub(super) fn all(
        world: &'a World,
        mut active: &'a [bool],
        mut cells: &'a mut [Vec<CellSums>],
    ) -> Vec<Self> {
        let same = |s: &Setting, t: &Setting| (s.border, s.bench.points) == (t.border, t.bench.points);
        let mut families = Vec::new();
        for settings in world.settings.chunk_by(same) {
            let first = families.len();
            families.extend(world.pulses.checkpoints.iter().enumerate().map(|(checkpoint, &samples)| Self {
                checkpoint,
                samples,
                period: settings[0].period,
                bench: &settings[0].bench,
                levels: Vec::with_capacity(settings.len()),
            }));
            for setting in settings {
                for family in &mut families[first..] {
                    let methods = setting.methods.len();
                    let (own, rest) = cells.split_at_mut(methods);
                    cells = rest;
                    let contenders = setting.methods.iter().zip(own).zip(&active[..methods]);
                    let cells = contenders
                        .filter(|(_, active)| **active)
                        .map(|((contender, sums), _)| Cell::new(contender, sums))
                        .collect();
                    family.levels.push(NoiseLevel { setting, cells });
                    active = &active[methods..];
                }
            }
        }
        families
    }

    /// Estimates every active cell from the noise of some replicates of a round, in order.
    pub(super) fn run(mut self, noise: &[LaneNoise], round: &Round) {
        self.levels.retain(|level| !level.cells.is_empty());
        if self.levels.is_empty() {
            return;
        }
        let empty = Lanes::new(self.bench.superpositions(self.samples));
        let mut abreast = vec![empty; ABREAST.min(noise.len())];
        let mut memory = Memory::default();
        for noise in noise.chunks(ABREAST) {
            let all = &mut abreast[..noise.len()];
            for (lanes, noise) in all.iter_mut().zip(noise) {
                lanes.load(noise, round, (self.checkpoint, self.period));
            }
            for level in &mut self.levels {
                for (lanes, noise) in all.iter_mut().zip(noise) {
                    lanes.superpose(level.setting, noise, (self.checkpoint, self.samples));
                }
                for cell in &mut level.cells {
                    all.iter().for_each(|lanes| lanes.estimate(self.bench, cell, &mut memory));
                }
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
#[derive(Clone)]
struct Lanes {
    first: u32,
    /// Index of the number of samples.
    checkpoint: usize,
    /// Sections of the replicates, in order.
    sections: Vec<usize>,
    /// Whether there is noise of the experiment: whether any method looks at it.
    used: [bool; 2],
    superpositions: [LaneSuperposition; 2],
    statistics: [LaneStatistics; 2],
    steps: [LaneStep; 2],
}

/// What one cell leaves to the next.
#[derive(Default)]
struct Memory {
    fit: LaneFit,
    terms: LaneTerms,
}

impl Lanes {
    fn new(superpositions: [LaneSuperposition; 2]) -> Self {
        Self {
            first: 0,
            checkpoint: 0,
            sections: Vec::with_capacity(LANES),
            used: [false; 2],
            statistics: [0, 1].map(|k| superpositions[k].statistics()),
            superpositions,
            steps: [LaneStep { mean: Lane::ZERO, samples: 0.0 }; 2],
        }
    }

    /// Takes in the noise of other replicates.
    fn load(&mut self, noise: &LaneNoise, round: &Round, (checkpoint, period): (usize, usize)) {
        (self.first, self.checkpoint) = (noise.first, checkpoint);
        self.sections.clear();
        self.sections.extend((0..noise.live).map(|l| round.section(noise.first as usize + l)));
        for k in 0..2 {
            self.used[k] = !noise.pulses[k].is_empty();
            if self.used[k] {
                self.superpositions[k].load(&noise.pulses[k][checkpoint][period]);
            }
        }
    }

    fn superpose(&mut self, setting: &Setting, noise: &LaneNoise, (checkpoint, samples): (usize, usize)) {
        for k in (0..2).filter(|k| self.used[*k]) {
            self.superpositions[k].at(setting.sigma, &mut self.statistics[k]);
            let unit = noise.steps[k].get(checkpoint).copied().unwrap_or(Lane::ZERO);
            let mean = unit * setting.sigma + Lane::splat(setting.bench.satellite_output(k));
            self.steps[k] = LaneStep { mean, samples: samples as f64 };
        }
    }

    /// Adds one method's errors to the sums of a cell.
    fn estimate(&self, bench: &Bench, cell: &mut Cell<'_>, memory: &mut Memory) {
        let Memory { fit, terms } = memory;
        let contender = cell.contender;
        let [descendant, ascendant] = &self.statistics;
        let both = [descendant, ascendant];
        let parts = match contender.kind.experiments() {
            &[k] => &both[k..=k],
            _ => &both[..],
        };
        let step = contender.kind.needs_step().then(|| self.steps[contender.kind.experiments()[0]]);
        contender.lanes.fit(parts, step, fit);
        let means = &contender.means[self.checkpoint];
        contender.control.terms(parts, step.map(|s| s.mean), means, terms);
        let errors = LaneErrors {
            truth: &contender.truth,
            values: &fit.values,
            variances: &fit.variances,
            first_order: &terms.first,
            second_order: &terms.second,
        };
        // Replicates that follow each other in a section are added in one go.
        let mut next = 0;
        for run in self.sections.chunk_by(|s, t| s == t) {
            let (sums, running) = cell.enter(run[0]);
            sums.replicates += run.len();
            let end = next + run.len();
            while next < end {
                let sound = (next..end).take_while(|l| fit.sound[*l]).count();
                if sound > 0 {
                    running.add(errors, next..next + sound);
                    next += sound;
                } else {
                    self.estimate_alone(next, contender, bench, sums);
                    next += 1;
                }
            }
        }
    }

    /// A replicate that the lanes could not solve, or its failure.
    fn estimate_alone(&self, l: usize, contender: &Contender, bench: &Bench, sums: &mut CellSums) {
        let steps = self.steps.map(|s| StepMean { mean: s.mean.0[l], samples: s.samples });
        contender.kind.with_input(&bench.replicate(&self.statistics, l), steps, |method| {
            match method.fit() {
                Ok(fit) => {
                    let errors =
                        fit.parameters().zip(&contender.truth).map(|(x, truth)| (x.value - truth, x.se));
                    sums.push(errors, &contender.terms(self.checkpoint, &method));
                }
                Err(error) => sums.fail(self.first + l as u32, error.to_string()),
            }
        });
    }
}
