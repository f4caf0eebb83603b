//! The methods, eight replicates abreast.

use super::arrow::{Core, Equations, Regression};
use super::columns::{ColumnPlan, ColumnValues};
use super::constrained::Constrained;
use super::fit::LaneFit;
use super::folded::LaneFolds;
use super::levels::{LocalColumns, Reading};
use super::sample::LaneSample;
use super::sized::{SizedWork, run};
use crate::pulse::PulseMethod;
use crate::pulse::efficient::constrained_levels;
use crate::pulse::experiments::Experiments;
use crate::pulse::layout::Layout;
use crate::pulse::level_rule::LevelRule;
use switchback_noise::lanes::{LANES, Lane, keep_apart};

/// A method for experiments of given designs: all that is the same in every replicate.
///
/// What [`PulseMethod::fit`] does for one replicate, [`LaneMethod::fit`] does for eight, without allocating. Replicates that it cannot
/// solve it leaves to the former, which knows what to say of them.
#[derive(Debug, Clone)]
pub struct LaneMethod {
    order: usize,
    kind: Kind,
}

#[derive(Debug, Clone)]
enum Kind {
    Regression(Box<LaneRegression>),
    /// Nothing where the lanes do not know the experiments.
    Folds(Option<LaneFolds>),
}

/// A method that is a regression over groups.
#[derive(Debug, Clone)]
struct LaneRegression {
    plan: ColumnPlan,
    values: ColumnValues,
    levels: Vec<LevelRule>,
    constrained: Option<Constrained>,
}

impl LaneMethod {
    /// The method of `example` for experiments of the same designs.
    pub fn of(example: &PulseMethod<'_>) -> Self {
        let data = example.experiments();
        let experiments = Experiments::new(&data);
        let kind = if let PulseMethod::Instrumental(_) = example {
            Kind::Folds(LaneFolds::of(&data))
        } else {
            let Layout { columns, levels } = example.layout(&experiments);
            let (levels, constrained) = match example {
                PulseMethod::Efficient(_) => {
                    (constrained_levels(&levels), Some(Constrained::new(&experiments, &levels)))
                }
                _ => (levels, None),
            };
            let (plan, values) = ColumnPlan::of(&columns, true);
            Kind::Regression(Box::new(LaneRegression { plan, values, levels: levels.concat(), constrained }))
        };
        Self { order: experiments.order(), kind }
    }

    /// The estimates from each sample, in as many of `fits`.
    ///
    /// Several samples are fitted in the time that one spends on waiting for its divisions and roots. Orders above
    /// [`LARGEST_ORDER`](super::sized::LARGEST_ORDER) are all left to the solver that goes one by one.
    ///
    /// # Panics
    /// If there are fewer fits than samples.
    pub fn fit(&self, samples: &[LaneSample<'_>], fits: &mut [LaneFit]) {
        let fits = &mut fits[..samples.len()];
        match &self.kind {
            Kind::Folds(Some(folds)) => {
                for (sample, fit) in samples.iter().zip(fits) {
                    folds.fit(self.order, sample, fit);
                }
            }
            Kind::Folds(None) => fits.iter_mut().for_each(|fit| fit.sound = [false; LANES]),
            Kind::Regression(method) => {
                let size = self.order + method.plan.width;
                for (samples, fits) in samples.chunks(ABREAST).zip(fits.chunks_mut(ABREAST)) {
                    if !run(self.order, size, Fit { method, samples, fits }) {
                        fits.iter_mut().for_each(|fit| fit.sound = [false; LANES]);
                    }
                }
            }
        }
    }
}

/// Samples that are fitted in the same go.
const ABREAST: usize = 4;

/// [`LaneMethod::fit`] on its way, up to [`ABREAST`] samples.
struct Fit<'a> {
    method: &'a LaneRegression,
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

impl LaneRegression {
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
        let (coefficients, points) = values.split_at_mut(2 * N);
        let (coefficient_variances, point_variances) = variances.split_at_mut(2 * N);
        reading.coefficients(coefficients, coefficient_variances);
        let mut spoilt = Lane::ZERO;
        for (value, variance) in coefficients.iter().zip(coefficient_variances) {
            keep_apart();
            spoilt += LaneFit::spoilt(*value, *variance);
        }
        for (rule, (value, variance)) in self.levels.iter().zip(points.iter_mut().zip(point_variances)) {
            keep_apart();
            (*value, *variance) = reading.level(*rule);
            spoilt += LaneFit::spoilt(*value, *variance);
        }
        *sound = core.sound;
        fit.leave_out(spoilt);
    }
}
