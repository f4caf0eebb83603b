//! Common-noise groups: cells that share their noise.

use super::cell::{ActiveCells, CellSpec, CellTheory};
use super::cell_design::{self, CellDesign, MethodCase};
use super::cell_group::CellGroup;
use super::cell_group_plan::CellGroupPlan;
use super::error::StudyError;
use super::noise::{LaneNoise, NoiseSource, STREAMS, draw_lanes, eights};
use super::pulse_kind::PulseKind;
use super::setup::NoiseFilter;
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
    pub(super) cell_designs: Vec<CellDesign>,
    /// The cells in families.
    cell_groups: Vec<CellGroupPlan>,
}

/// Lays out the noise groups of a scenario.
///
/// With shared noise there is one noise group a case, and all of them use the same streams; with independent noise, one a cell, each with
/// its own.
pub(super) fn plan(scenario: &Scenario) -> Result<Vec<NoiseGroup>, StudyError> {
    let samples = &scenario.sweep().samples;
    let mut groups = Vec::new();
    for (index, case) in scenario.cases().iter().enumerate() {
        let cell_designs = cell_design::all(scenario, index, case)?;
        match scenario.coupling() {
            Coupling::Shared => groups.push(NoiseGroup::new(case, 0, samples, cell_designs)?),
            Coupling::Independent => {
                for cell_design in cell_designs {
                    for (n, method) in
                        samples.iter().flat_map(|n| cell_design.methods.iter().map(move |m| (n, m)))
                    {
                        let stream = STREAMS * groups.len() as u32;
                        let alone = CellDesign { methods: vec![method.clone()], ..cell_design.clone() };
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
        mut cell_designs: Vec<CellDesign>,
    ) -> Result<Self, StudyError> {
        let mut periods: Vec<usize> = cell_designs.iter().map(|s| s.setup.period()).collect();
        periods.sort_unstable();
        periods.dedup();
        let filter = NoiseFilter::of(case);
        let memory = NoiseMemory::of(&filter.ar);
        let expand = |cell_design: &mut CellDesign| {
            cell_design.period =
                periods.iter().position(|p| *p == cell_design.setup.period()).unwrap_or_default();
            cell_design.expand(case, (checkpoints, &memory))
        };
        // The first error in the order of the scenario, whichever thread was first.
        let expanded: Vec<_> = cell_designs.par_iter_mut().map(expand).collect();
        expanded.into_iter().collect::<Result<(), _>>()?;
        let burn_in = filter.burn_in();
        let NoiseFilter { ar, ma } = filter;
        let needs_steps = cell_designs.iter().flat_map(|s| &s.methods).any(|c| c.kind.needs_step());
        let kinds: Vec<PulseKind> = cell_designs.iter().flat_map(|s| &s.methods).map(|c| c.kind).collect();
        let folds = kinds.iter().any(|kind| kind.folds());
        let lags = if folds { Folds::lags(case.order) } else { case.order };
        let pulses = NoisePlan { ar, ma, lags, periods, checkpoints: checkpoints.to_vec(), burn_in };
        let steps =
            needs_steps.then(|| MeanNoise::new(&pulses).expect("a scenario's filter and samples are valid"));
        let experiments = [0, 1].map(|k| kinds.iter().any(|kind| kind.experiments().contains(&k)));
        let of_period = |period: usize| {
            cell_designs.iter().find(|s| s.period == period).expect("periods are the settings'")
        };
        let grouping = |period, samples| of_period(period).setup.grouping(samples);
        let groupings = checkpoints
            .iter()
            .map(|&n| (0..pulses.periods.len()).map(|p| grouping(p, n)).collect())
            .collect();
        let cell_groups = CellGroupPlan::all(&cell_designs, checkpoints);
        let noise = NoiseSource { stream, pulses, order: case.order, steps, experiments, groupings };
        Ok(Self { noise, cell_designs, cell_groups })
    }

    /// The cells, in the order in which their sums are kept: setting, number of samples, method.
    pub(super) fn cells(&self) -> impl Iterator<Item = (&CellDesign, usize, &MethodCase)> {
        self.cell_designs.iter().flat_map(move |cell_design| {
            self.noise
                .pulses
                .checkpoints
                .iter()
                .flat_map(move |&samples| cell_design.methods.iter().map(move |c| (cell_design, samples, c)))
        })
    }

    /// What tables and verdicts need of the cells, in the same order.
    pub(super) fn specs(&self, scenario: &Scenario) -> Vec<CellSpec> {
        self.cells()
            .map(|(cell_design, samples, method_case)| CellSpec {
                series: cell_design.series(scenario, method_case.method),
                samples,
                parameters: method_case.parameters.clone(),
                truth: method_case.truth.clone(),
            })
            .collect()
    }

    /// What theory says of the cells, in the same order.
    pub(super) fn theories(&self) -> Vec<CellTheory> {
        let memory = NoiseMemory::of(&self.noise.pulses.ar);
        let checkpoints = &self.noise.pulses.checkpoints;
        let of = |cell_design: &CellDesign,
                  (checkpoint, samples): (usize, usize),
                  method_case: &MethodCase| {
            let MethodCase { kind, theory, ref expansions, .. } = *method_case;
            let (setup, limit) = (&cell_design.setup, &expansions[checkpoint].limit);
            if !theory {
                let ErrorTerms { first, second } = setup.mean_terms(kind, limit, cell_design.sigma, samples);
                let control = first.iter().zip(second).map(|(first, second)| first + second).collect();
                return CellTheory { control: Some(control), ..CellTheory::default() };
            }
            let (theory, cumulants) = setup.theory(kind, limit, (cell_design.sigma, &memory), samples);
            let bound = setup.bound(kind, cell_design.sigma, samples);
            CellTheory {
                sd: Some(theory.sd),
                // The control of the folds is of first order: its mean is zero.
                control: Some(if kind.folds() { vec![0.0; theory.bias.len()] } else { theory.bias.clone() }),
                bias: Some(theory.bias),
                bound: Some(bound.expect("determined, as the method's own limit is")),
                coverage: Some(cumulants.iter().map(|c| c.chance_within(normal_quantile_975())).collect()),
                controls: None,
            }
        };
        let of_cell_design = |cell_design: &CellDesign| -> Vec<CellTheory> {
            let at = |(checkpoint, &samples)| {
                cell_design.methods.iter().map(move |c| of(cell_design, (checkpoint, samples), c))
            };
            checkpoints.iter().enumerate().flat_map(at).collect()
        };
        let of_cell_designs: Vec<_> = self.cell_designs.par_iter().map(of_cell_design).collect();
        of_cell_designs.into_iter().flatten().collect()
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
        let take_in = |cell_group: CellGroup<'a>| -> Task<'a> {
            Box::new(move |memory| cell_group.run(chunk.noise, memory))
        };
        CellGroup::all(&self.cell_groups, &self.cell_designs, cells).into_iter().map(take_in).collect()
    }
}
