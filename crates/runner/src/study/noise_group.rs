//! Common-noise groups: cells that share their noise.

use super::StudyError;
use super::bench::{Bench, Bound, NoiseFilter};
use super::cell::{ActiveCells, CellSpec, Chunk, ParameterName, Task, Workload};
use super::execute::{BATCH, Round};
use super::family::{Family, FamilyPlan};
use super::moments::{LaneNoise, draw_lanes};
use super::pulse_kind::PulseKind;
use crate::results::{Group, Series};
use crate::scenario::{Case, Coupling, Disturbance, Method, Scenario};
use rayon::prelude::*;
use std::ops::Range;
use switchback_estimator::estimators::pulse::lanes::{LANES, LaneControl, LaneMethod};
use switchback_estimator::estimators::pulse::{ErrorTerms, Limit, PulseFitError, PulseMethod};
use switchback_estimator::simulation::Grouping;
use switchback_estimator::simulation::noise::{MeanNoise, NoisePlan};

/// Streams of a noise group: descendant, ascendant, and the two step experiments.
pub(super) const STREAMS: u32 = 4;

/// Everything that one pass over the noise of one replicate serves.
#[derive(Debug, Clone)]
pub(super) struct NoiseGroup {
    /// First of its [`STREAMS`] noise streams.
    pub(super) stream: u32,
    /// What to record of the pulse experiments' noise.
    pub(super) pulses: NoisePlan,
    /// The mean noise in a step experiment; `None` where no method asks for it.
    pub(super) steps: Option<MeanNoise>,
    /// Whether any method looks at the descendant, at the ascendant experiment.
    pub(super) experiments: [bool; 2],
    pub(super) settings: Vec<Setting>,
    /// How samples are sorted into groups, by number of samples and period.
    pub(super) groupings: Vec<Vec<Grouping>>,
    /// The cells in families.
    families: Vec<FamilyPlan>,
}

/// One bench at one noise level: the cells over N and methods.
#[derive(Debug, Clone)]
pub(super) struct Setting {
    pub(super) case: usize,
    pub(super) border: usize,
    pub(super) bench: Bench,
    pub(super) sigma: f64,
    /// Index of the bench's period in the plan.
    pub(super) period: usize,
    pub(super) methods: Vec<Contender>,
}

/// A method in a setting.
#[derive(Debug, Clone)]
pub(super) struct Contender {
    pub(super) method: Method,
    pub(super) kind: PulseKind,
    pub(super) parameters: Vec<ParameterName>,
    pub(super) truth: Vec<f64>,
    /// The method's limit: control variate of every case, asymptotic theory where `theory` says so.
    pub(super) limit: Limit,
    /// Means of the error terms at the limit, one entry a number of samples of the noise group.
    pub(super) means: Vec<ErrorTerms>,
    /// The method, and the control variate, for eight replicates at a time.
    pub(super) lanes: LaneMethod,
    pub(super) control: LaneControl,
    /// Whether the model holds: the limit is then the truth, its theory the asymptotic one, and the bound applies.
    pub(super) theory: bool,
    pub(super) bound: Option<Bound>,
}

/// Lays out the noise groups of a scenario.
///
/// With shared noise there is one noise group a case, and all of them use the same streams; with independent noise, one a cell, each with
/// its own.
pub(super) fn plan(scenario: &Scenario) -> Result<Vec<NoiseGroup>, StudyError> {
    let samples = &scenario.sweep().samples;
    let mut groups = Vec::new();
    for (index, case) in scenario.cases().iter().enumerate() {
        let settings = settings(scenario, index, case)?;
        match scenario.coupling() {
            Coupling::Shared => groups.push(NoiseGroup::new(case, 0, samples, settings)),
            Coupling::Independent => {
                for setting in settings {
                    for (n, method) in
                        samples.iter().flat_map(|n| setting.methods.iter().map(move |m| (n, m)))
                    {
                        let stream = STREAMS * groups.len() as u32;
                        let alone = Setting { methods: vec![method.clone()], ..setting.clone() };
                        groups.push(NoiseGroup::new(case, stream, &[*n], vec![alone]));
                    }
                }
            }
        }
    }
    Ok(groups)
}

impl NoiseGroup {
    fn new(case: &Case, stream: u32, checkpoints: &[usize], mut settings: Vec<Setting>) -> Self {
        let mut periods: Vec<usize> = settings.iter().map(|s| s.bench.period()).collect();
        periods.sort_unstable();
        periods.dedup();
        settings.par_iter_mut().for_each(|setting| {
            setting.period = periods.iter().position(|p| *p == setting.bench.period()).unwrap_or_default();
            for contender in &mut setting.methods {
                let mean =
                    |&n: &usize| setting.bench.mean_terms(contender.kind, &contender.limit, setting.sigma, n);
                contender.means = checkpoints.iter().map(mean).collect();
            }
        });
        let filter = NoiseFilter::of(case);
        let burn_in = filter.burn_in();
        let NoiseFilter { ar, ma } = filter;
        let needs_steps = settings.iter().flat_map(|s| &s.methods).any(|c| c.kind.needs_step());
        let pulses =
            NoisePlan { ar, ma, lags: case.order, periods, checkpoints: checkpoints.to_vec(), burn_in };
        let steps =
            needs_steps.then(|| MeanNoise::new(&pulses).expect("a scenario's filter and samples are valid"));
        let kinds: Vec<PulseKind> = settings.iter().flat_map(|s| &s.methods).map(|c| c.kind).collect();
        let experiments = [0, 1].map(|k| kinds.iter().any(|kind| kind.experiments().contains(&k)));
        let of_period =
            |period: usize| settings.iter().find(|s| s.period == period).expect("periods are the settings'");
        let grouping = |period, samples| of_period(period).bench.grouping(samples);
        let groupings = checkpoints
            .iter()
            .map(|&n| (0..pulses.periods.len()).map(|p| grouping(p, n)).collect())
            .collect();
        let families = FamilyPlan::all(&settings, checkpoints);
        Self { stream, pulses, steps, experiments, settings, groupings, families }
    }

    /// The cells, in the order in which their sums are kept: setting, number of samples, method.
    pub(super) fn cells(&self) -> impl Iterator<Item = (&Setting, usize, &Contender)> {
        self.settings.iter().flat_map(move |setting| {
            self.pulses
                .checkpoints
                .iter()
                .flat_map(move |&samples| setting.methods.iter().map(move |c| (setting, samples, c)))
        })
    }

    /// What tables and verdicts need of the cells, in the same order.
    pub(super) fn specs(&self, scenario: &Scenario) -> Vec<CellSpec> {
        self.cells()
            .map(|(setting, samples, contender)| CellSpec {
                series: setting.series(scenario, contender.method),
                samples,
                parameters: contender.parameters.clone(),
                truth: contender.truth.clone(),
                theory: contender.theory.then(|| contender.limit.theory_se(samples as f64)),
                bound: contender.bound.as_ref().map(|b| b.sd(samples as f64)),
            })
            .collect()
    }
}

impl Setting {
    /// The curve over N of one of its methods.
    pub(super) fn series(&self, scenario: &Scenario, method: Method) -> Series {
        let case = &scenario.cases()[self.case];
        Series {
            case: case.name.clone(),
            border: case.borders[self.border].name.clone(),
            method,
            points: self.bench.points,
            noise: self.sigma,
        }
    }
}

fn settings(scenario: &Scenario, index: usize, case: &Case) -> Result<Vec<Setting>, StudyError> {
    let sweep = scenario.sweep();
    let benches: Vec<(usize, usize)> =
        (0..case.borders.len()).flat_map(|b| sweep.points.iter().map(move |&points| (b, points))).collect();
    let of_bench = |&(b, points): &(usize, usize)| {
        let border = &case.borders[b];
        let bench = Bench::new(case, border, points)?;
        let contender = |method: Method, kind, sigma| {
            Contender::new(case, &bench, sigma, method, kind).map_err(|source| StudyError::NoLimit {
                method: method.name(),
                case: case.name.clone(),
                border: border.name.clone(),
                points,
                source,
            })
        };
        let setting = |&sigma: &f64| {
            let kinds = sweep.methods.iter().filter_map(|&method| Some((method, PulseKind::of(method)?)));
            let methods =
                kinds.map(|(method, kind)| contender(method, kind, sigma)).collect::<Result<_, _>>()?;
            Ok(Setting { case: index, border: b, bench: bench.clone(), sigma, period: 0, methods })
        };
        sweep.noise.iter().map(setting).collect::<Result<Vec<_>, StudyError>>()
    };
    let settings: Vec<Result<Vec<Setting>, StudyError>> = benches.par_iter().map(of_bench).collect();
    // The first error in the order of the scenario, whichever thread was first.
    Ok(settings.into_iter().collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect())
}

impl Contender {
    fn new(
        case: &Case,
        bench: &Bench,
        sigma: f64,
        method: Method,
        kind: PulseKind,
    ) -> Result<Self, PulseFitError> {
        let limit = bench.limit(kind, sigma)?;
        let theory = kind.models_hysteresis() && keeps_assumptions(case, bench);
        Ok(Self {
            method,
            kind,
            parameters: parameters(case.order, bench, kind),
            truth: bench.truth(kind),
            lanes: bench.lanes(kind),
            control: limit.lanes(),
            limit,
            means: Vec::new(),
            theory,
            bound: if theory { Some(bench.bound(kind, sigma)?) } else { None },
        })
    }

    /// The leading terms of one replicate's error, less their means.
    pub(super) fn terms(&self, checkpoint: usize, sample: &PulseMethod<'_>) -> ErrorTerms {
        self.limit.terms(sample).less(&self.means[checkpoint])
    }
}

/// Whether the paper's assumptions hold: white equation error, the right order, masked memory.
fn keeps_assumptions(case: &Case, bench: &Bench) -> bool {
    matches!(case.disturbance, Disturbance::White)
        && case.order == case.system.order()
        && case.spacing >= case.order
        && (case.spacing >= 2 || bench.points <= 2)
}

fn parameters(order: usize, bench: &Bench, kind: PulseKind) -> Vec<ParameterName> {
    let border = |&k: &usize| ([Group::Descending, Group::Ascending][k], bench.levels(k));
    ParameterName::all(order, &kind.experiments().iter().map(border).collect::<Vec<_>>())
}

impl Workload for NoiseGroup {
    fn cells(&self) -> usize {
        NoiseGroup::cells(self).count()
    }

    /// A batch a task.
    fn draw<'a>(
        &'a self,
        round: &'a Round,
        chunk: Range<usize>,
        noise: &'a mut Vec<LaneNoise>,
    ) -> Vec<Task<'a>> {
        let end = chunk.end as u32;
        noise.resize_with(chunk.len().div_ceil(LANES), LaneNoise::default);
        let batches = (chunk.start as u32..end).step_by(BATCH).zip(noise.chunks_mut(BATCH / LANES));
        let draw = |(first, noise): (u32, &'a mut [LaneNoise])| -> Task<'a> {
            let batch = first..end.min(first + BATCH as u32);
            Box::new(move |_| draw_lanes(self, round, batch, noise))
        };
        batches.map(draw).collect()
    }

    /// A family a task: each takes in its replicates in order, so that the order in which errors are added up does not depend on threads.
    fn take_in<'a>(&'a self, chunk: Chunk<'a>, cells: ActiveCells<'a>) -> Vec<Task<'a>> {
        let take_in =
            |family: Family<'a>| -> Task<'a> { Box::new(move |memory| family.run(chunk.noise, memory)) };
        Family::all(&self.families, &self.settings, cells).into_iter().map(take_in).collect()
    }
}
