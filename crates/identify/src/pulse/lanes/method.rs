//! The methods, eight replicates abreast.

use super::arrow::{Core, Equations, Locals, Regression};
use super::columns::{ColumnPlan, ColumnValues};
use super::constrained::Constrained;
use super::folded::{FoldWork, LaneFolds};
use super::levels::{LocalColumns, Reading};
use super::sized::{SizedWork, run};
use super::statistics::LaneStatistics;
use crate::pulse::PulseMethod;
use crate::pulse::experiments::{Experiments, first_level_value, satellite_value};
use crate::pulse::{linear_arx, memoryless, paper};
use switchback_noise::lanes::{LANES, Lane, keep_apart};

/// A level's value relative to the base.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum LevelRule {
    /// Not estimated.
    Known(f64),
    /// (3.24b) from the local columns `first…first+n−1`, `plus` the satellite's value.
    RankOne { first: usize, plus: f64 },
    /// A local column itself.
    Local(usize),
}

/// A method for experiments of given designs: all that is the same in every replicate.
///
/// What [`PulseMethod::fit`] does for one replicate, [`LaneMethod::fit`] does for eight, without allocating. Replicates that it cannot
/// solve it leaves to the former, which knows what to say of them.
#[derive(Debug, Clone)]
pub struct LaneMethod {
    order: usize,
    plan: ColumnPlan,
    values: ColumnValues,
    levels: Vec<LevelRule>,
    constrained: Option<Constrained>,
    /// In place of all that, for the method that works on the folds: nothing where the lanes do not know the experiments.
    folded: Option<Option<LaneFolds>>,
}

/// Mean of the step experiment's output in each replicate.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LaneStep {
    /// `ŷ₀`.
    pub mean: Lane,
    /// Samples averaged.
    pub samples: f64,
}

/// Eight replicates as a method sees them.
#[derive(Debug, Clone, Copy)]
pub struct LaneSample<'a> {
    /// The statistics of the method's experiments, in their order.
    pub parts: &'a [&'a LaneStatistics],
    /// The step experiment, for the paper's methods.
    pub step: Option<LaneStep>,
}

/// Estimates of eight replicates with their variances; memory that is used again and again.
#[derive(Debug, Clone, Default)]
pub struct LaneFit {
    /// `a`, `b`, then the border points: the order of [`super::super::PulseFit::parameters`].
    pub values: Vec<Lane>,
    /// Their variances: the squares of the standard errors.
    pub variances: Vec<Lane>,
    /// Whether the replicate has an estimate; if not, ask [`PulseMethod::fit`] why.
    pub sound: [bool; LANES],
    pub(super) locals: Locals,
    pub(super) linearised: ColumnValues,
    pub(super) folded: FoldWork,
}

impl LaneMethod {
    /// The method of `example` for experiments of the same designs.
    pub fn of(example: &PulseMethod<'_>) -> Self {
        let experiments = Experiments::new(&example.experiments());
        let n = experiments.order();
        if let PulseMethod::Instrumental(_) = example {
            let columns = experiments.rank_free_columns();
            let (plan, values) = ColumnPlan::of(&columns, true);
            let folded = Some(LaneFolds::of(&example.experiments()));
            return Self { order: n, plan, values, levels: Vec::new(), constrained: None, folded };
        }
        let rank_one = |first: usize, plus: f64| LevelRule::RankOne { first, plus };
        let mut constrained = None;
        let (columns, levels) = match example {
            PulseMethod::Paper { experiment, .. } => {
                let first = first_level_value(experiment.branch) - satellite_value(experiment.branch);
                let inner = (1..experiment.points()).map(|j| rank_one((j - 1) * n, 0.0));
                (
                    paper::pulse_columns(&experiments),
                    std::iter::once(LevelRule::Known(first)).chain(inner).collect(),
                )
            }
            PulseMethod::Joint { .. } => (experiments.rank_free_columns(), rank_free(&experiments)),
            PulseMethod::Efficient(_) => {
                let start = rank_free(&experiments);
                let mut next = 0..;
                let levels = start.iter().map(|rule| match rule {
                    LevelRule::RankOne { .. } => LevelRule::Local(next.next().unwrap_or_default()),
                    known => *known,
                });
                let levels = levels.collect();
                constrained = Some(Constrained::new(&experiments, start));
                (experiments.rank_free_columns(), levels)
            }
            PulseMethod::Instrumental(_) => unreachable!("it has no columns"),
            PulseMethod::LinearArx(_) => {
                let (columns, positions) = linear_arx::columns(&experiments);
                (columns, positions.into_iter().flatten().map(LevelRule::Known).collect())
            }
            PulseMethod::Memoryless(_) => {
                let (columns, curve) = memoryless::columns(&experiments);
                let levels =
                    curve.of_experiment.iter().zip(&experiments.parts).flat_map(|(indices, part)| {
                        let inner = indices.iter().map(|k| rank_one(k * n, 0.0));
                        std::iter::once(LevelRule::Known(first_level_value(part.branch))).chain(inner)
                    });
                (columns, levels.collect())
            }
        };
        let (plan, values) = ColumnPlan::of(&columns, true);
        Self { order: n, plan, values, levels, constrained, folded: None }
    }

    /// The estimates from each sample, in as many of `fits`.
    ///
    /// Several samples are fitted in the time that one spends on waiting for its divisions and roots. Orders above
    /// [`LARGEST_ORDER`](super::LARGEST_ORDER) are all left to the solver that goes one by one.
    ///
    /// # Panics
    /// If there are fewer fits than samples.
    pub fn fit(&self, samples: &[LaneSample<'_>], fits: &mut [LaneFit]) {
        let fits = &mut fits[..samples.len()];
        if let Some(folded) = &self.folded {
            for (sample, fit) in samples.iter().zip(fits) {
                match folded {
                    Some(folds) => folds.fit(self.order, sample, fit),
                    None => fit.sound = [false; LANES],
                }
            }
            return;
        }
        for (samples, fits) in samples.chunks(ABREAST).zip(fits.chunks_mut(ABREAST)) {
            if !run(self.order, self.order + self.plan.width, Fit { method: self, samples, fits }) {
                fits.iter_mut().for_each(|fit| fit.sound = [false; LANES]);
            }
        }
    }
}

/// Samples that are fitted in the same go.
const ABREAST: usize = 4;

/// [`LaneMethod::fit`] on its way, up to [`ABREAST`] samples.
struct Fit<'a> {
    method: &'a LaneMethod,
    samples: &'a [LaneSample<'a>],
    fits: &'a mut [LaneFit],
}

impl SizedWork for Fit<'_> {
    #[inline(always)]
    fn run<const N: usize, const D: usize>(self) {
        let Self { method, samples, fits } = self;
        let mut equations: [Option<Equations<D>>; ABREAST] = [const { None }; ABREAST];
        for (equations, (sample, fit)) in equations.iter_mut().zip(samples.iter().zip(&mut *fits)) {
            keep_apart();
            *equations = Some(Equations::of::<N>(&method.regression(sample), &mut fit.locals));
        }
        // Next to each other, the divisions and roots of one sample do not keep the next waiting.
        let mut cores: [Option<Core<N, D>>; ABREAST] = [const { None }; ABREAST];
        for (core, (equations, sample)) in cores.iter_mut().zip(equations.iter().flatten().zip(samples)) {
            keep_apart();
            *core = Some(Core::solve(equations, &method.regression(sample)));
        }
        for (core, (sample, fit)) in cores.iter_mut().flatten().zip(samples.iter().zip(fits)) {
            keep_apart();
            method.read(core, sample, fit);
        }
    }
}

impl LaneMethod {
    #[inline(always)]
    fn regression<'a>(&'a self, sample: &LaneSample<'a>) -> Regression<'a> {
        let shift = match sample.step {
            Some(step) => step.mean,
            None => Lane::ZERO,
        };
        Regression { parts: sample.parts, shift, plan: &self.plan, values: &self.values }
    }

    /// The parameters, given the solved core.
    #[inline(always)]
    fn read<const N: usize, const D: usize>(
        &self,
        core: &mut Core<N, D>,
        sample: &LaneSample<'_>,
        fit: &mut LaneFit,
    ) {
        let LaneFit { values, variances, sound, locals, linearised, .. } = fit;
        let regression = self.regression(sample);
        let columns = if let Some(constrained) = &self.constrained {
            core.follow(&regression, locals);
            *core = constrained.iterate(sample.parts, core, locals, linearised);
            LocalColumns::Kept(locals)
        } else if self.plan.apart {
            LocalColumns::Means(&regression)
        } else {
            core.follow(&regression, locals);
            LocalColumns::Kept(locals)
        };
        values.resize(2 * N + self.levels.len(), Lane::ZERO);
        variances.resize(values.len(), Lane::ZERO);
        let reading = Reading::new(core, columns, sample.step);
        // Zero times a number is zero, times anything else it is not.
        let mut spoilt = Lane::ZERO;
        let (coefficients, points) = values.split_at_mut(2 * N);
        let (coefficient_variances, point_variances) = variances.split_at_mut(2 * N);
        reading.coefficients(coefficients, coefficient_variances);
        for (value, variance) in coefficients.iter().zip(coefficient_variances) {
            keep_apart();
            spoilt += (*value + *variance) * 0.0;
        }
        for (rule, (value, variance)) in self.levels.iter().zip(points.iter_mut().zip(point_variances)) {
            keep_apart();
            (*value, *variance) = reading.level(*rule);
            spoilt += (*value + *variance) * 0.0;
        }
        *sound = core.sound;
        for l in 0..LANES {
            sound[l] &= spoilt.0[l] == 0.0;
        }
    }
}

/// Levels of the regression with a free mean for every (level, lag), as in `joint`.
fn rank_free(experiments: &Experiments<'_>) -> Vec<LevelRule> {
    experiments
        .parts
        .iter()
        .enumerate()
        .flat_map(|(e, part)| {
            let plus = satellite_value(part.branch);
            let inner = (1..part.points()).map(move |j| (e, j, plus));
            std::iter::once(LevelRule::Known(first_level_value(part.branch))).chain(
                inner.map(|(e, j, plus)| LevelRule::RankOne {
                    first: experiments.rank_free_local(e, j, 1),
                    plus,
                }),
            )
        })
        .collect()
}
