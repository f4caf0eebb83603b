//! Common-noise groups: cells that share their noise.

use super::bench::NoiseFilter;
use super::cell::{ActiveCells, CellSpec, CellTheory};
use super::error::StudyError;
use super::family::Family;
use super::family_plan::FamilyPlan;
use super::noise::{LaneNoise, NoiseSource, STREAMS, draw_lanes, eights};
use super::pulse_kind::PulseKind;
use super::setting::{self, Contender, Setting};
use super::workload::{Chunk, Task, Workload};
use crate::scenario::{Case, Coupling, Scenario};
use rayon::prelude::*;
use std::ops::Range;
use switchback_identify::pulse::lanes::LANES;
use switchback_identify::pulse::{ErrorTerms, Folds};
use switchback_identify::statistics::normal_quantile_975;
use switchback_model::linear::NoiseMemory;
use switchback_noise::{MeanNoise, NoisePlan};

/// Replicates of one noise pass: a whole number of lanes at every width.
const PASS: usize = 16;

/// Everything that one pass over the noise of one replicate serves.
#[derive(Debug, Clone)]
pub(super) struct NoiseGroup {
    pub(super) noise: NoiseSource,
    pub(super) settings: Vec<Setting>,
    /// The cells in families.
    families: Vec<FamilyPlan>,
}

/// Lays out the noise groups of a scenario.
///
/// With shared noise there is one noise group a case, and all of them use the same streams; with independent noise, one a cell, each with
/// its own.
pub(super) fn plan(scenario: &Scenario) -> Result<Vec<NoiseGroup>, StudyError> {
    let samples = &scenario.sweep().samples;
    let mut groups = Vec::new();
    for (index, case) in scenario.cases().iter().enumerate() {
        let settings = setting::all(scenario, index, case)?;
        match scenario.coupling() {
            Coupling::Shared => groups.push(NoiseGroup::new(case, 0, samples, settings)?),
            Coupling::Independent => {
                for setting in settings {
                    for (n, method) in
                        samples.iter().flat_map(|n| setting.methods.iter().map(move |m| (n, m)))
                    {
                        let stream = STREAMS * groups.len() as u32;
                        let alone = Setting { methods: vec![method.clone()], ..setting.clone() };
                        groups.push(NoiseGroup::new(case, stream, &[*n], vec![alone])?);
                    }
                }
            }
        }
    }
    Ok(groups)
}

impl NoiseGroup {
    fn new(
        case: &Case,
        stream: u32,
        checkpoints: &[usize],
        mut settings: Vec<Setting>,
    ) -> Result<Self, StudyError> {
        let mut periods: Vec<usize> = settings.iter().map(|s| s.bench.period()).collect();
        periods.sort_unstable();
        periods.dedup();
        let filter = NoiseFilter::of(case);
        let memory = NoiseMemory::of(&filter.ar);
        let expand = |setting: &mut Setting| {
            setting.period = periods.iter().position(|p| *p == setting.bench.period()).unwrap_or_default();
            setting.expand(case, (checkpoints, &memory))
        };
        // The first error in the order of the scenario, whichever thread was first.
        let expanded: Vec<_> = settings.par_iter_mut().map(expand).collect();
        expanded.into_iter().collect::<Result<(), _>>()?;
        let burn_in = filter.burn_in();
        let NoiseFilter { ar, ma } = filter;
        let needs_steps = settings.iter().flat_map(|s| &s.methods).any(|c| c.kind.needs_step());
        let kinds: Vec<PulseKind> = settings.iter().flat_map(|s| &s.methods).map(|c| c.kind).collect();
        let folds = kinds.iter().any(|kind| kind.folds());
        let lags = if folds { Folds::lags(case.order) } else { case.order };
        let pulses = NoisePlan { ar, ma, lags, periods, checkpoints: checkpoints.to_vec(), burn_in };
        let steps =
            needs_steps.then(|| MeanNoise::new(&pulses).expect("a scenario's filter and samples are valid"));
        let experiments = [0, 1].map(|k| kinds.iter().any(|kind| kind.experiments().contains(&k)));
        let of_period =
            |period: usize| settings.iter().find(|s| s.period == period).expect("periods are the settings'");
        let grouping = |period, samples| of_period(period).bench.grouping(samples);
        let groupings = checkpoints
            .iter()
            .map(|&n| (0..pulses.periods.len()).map(|p| grouping(p, n)).collect())
            .collect();
        let families = FamilyPlan::all(&settings, checkpoints);
        let noise = NoiseSource { stream, pulses, order: case.order, steps, experiments, groupings };
        Ok(Self { noise, settings, families })
    }

    /// The cells, in the order in which their sums are kept: setting, number of samples, method.
    pub(super) fn cells(&self) -> impl Iterator<Item = (&Setting, usize, &Contender)> {
        self.settings.iter().flat_map(move |setting| {
            self.noise
                .pulses
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
            })
            .collect()
    }

    /// What theory says of the cells, in the same order.
    pub(super) fn theories(&self) -> Vec<CellTheory> {
        let memory = NoiseMemory::of(&self.noise.pulses.ar);
        let checkpoints = &self.noise.pulses.checkpoints;
        let of = |setting: &Setting, (checkpoint, samples): (usize, usize), contender: &Contender| {
            let Contender { kind, theory, ref expansions, .. } = *contender;
            let (bench, limit) = (&setting.bench, &expansions[checkpoint].limit);
            if !theory {
                let ErrorTerms { first, second } = bench.mean_terms(kind, limit, setting.sigma, samples);
                let control = first.iter().zip(second).map(|(first, second)| first + second).collect();
                return CellTheory { control: Some(control), ..CellTheory::default() };
            }
            let (theory, cumulants) = bench.theory(kind, limit, (setting.sigma, &memory), samples);
            let bound = bench.bound(kind, setting.sigma, samples);
            CellTheory {
                sd: Some(theory.sd),
                // The control of the folds is of first order: its mean is zero.
                control: Some(if kind.folds() { vec![0.0; theory.bias.len()] } else { theory.bias.clone() }),
                bias: Some(theory.bias),
                bound: Some(bound.expect("determined, as the method's own limit is")),
                coverage: Some(cumulants.iter().map(|c| c.chance_within(normal_quantile_975())).collect()),
            }
        };
        let of_setting = |setting: &Setting| -> Vec<CellTheory> {
            let at = |(checkpoint, &samples)| {
                setting.methods.iter().map(move |c| of(setting, (checkpoint, samples), c))
            };
            checkpoints.iter().enumerate().flat_map(at).collect()
        };
        let of_settings: Vec<_> = self.settings.par_iter().map(of_setting).collect();
        of_settings.into_iter().flatten().collect()
    }
}

impl Workload for NoiseGroup {
    fn cells(&self) -> usize {
        NoiseGroup::cells(self).count()
    }

    /// A few replicates a task.
    fn draw<'a>(
        &'a self,
        seed: u64,
        replicates: Range<usize>,
        noise: &'a mut Vec<LaneNoise>,
    ) -> Vec<Task<'a>> {
        let Range { start, end } = replicates.start as u32..replicates.end as u32;
        let eights = eights(&(start..end));
        noise.resize_with(eights.len().div_ceil(LANES), LaneNoise::default);
        let passes = eights.step_by(PASS).zip(noise.chunks_mut(PASS / LANES));
        let draw = |(first, noise): (u32, &'a mut [LaneNoise])| -> Task<'a> {
            let pass = first.max(start)..end.min(first + PASS as u32);
            Box::new(move |_| draw_lanes(&self.noise, seed, pass, noise))
        };
        passes.map(draw).collect()
    }

    /// A family a task: each takes in its replicates in order, so that the order in which errors are added up does not depend on threads.
    fn take_in<'a>(&'a self, chunk: Chunk<'a>, cells: ActiveCells<'a>) -> Vec<Task<'a>> {
        let take_in =
            |family: Family<'a>| -> Task<'a> { Box::new(move |memory| family.run(chunk.noise, memory)) };
        Family::all(&self.families, &self.settings, cells).into_iter().map(take_in).collect()
    }
}
