//! Cells of methods of others: records in the open, and whoever estimates from them.

use super::cell::{ActiveCells, CellSpec, CellTheory, ParameterName};
use super::control_sums::{ControlShape, PairOfErrors};
use super::controls::ControlPlan;
use super::error::StudyError;
use super::noise::STREAMS;
use super::pulse_kind::PulseKind;
use super::replicate_errors::ReplicateErrors;
use super::sections::{CellSums, section};
use super::setup::{DIRECTIONS, NoiseFilter, Setup};
use super::workload::{Chunk, Task, Workload};
use crate::MethodName;
use crate::foreign::{Design, DesignExperiment, Estimates, ForeignEstimator, Records};
use crate::results::{Group, Series};
use crate::scenario::{Case, Coupling, Disturbance, ForeignMethod, Scenario};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;
use switchback_identify::statistics::ReplicateError;
use switchback_noise::{NoisePlan, NoiseSamples, StreamId, samples};

/// Replicates that are asked for at once.
const HANDFUL: usize = 8;

/// Methods of others on the cells of a case that share their noise.
#[derive(Debug)]
pub(super) struct ForeignNoiseGroup {
    stream: u32,
    noise: NoisePlan,
    /// Place of its first cell among all.
    first_cell: usize,
    cells: Vec<ForeignCell>,
    /// The records that they are estimated from.
    settings: Vec<Setting>,
}

/// One border, number of points and noise level.
#[derive(Debug)]
struct Setting {
    setup: Setup,
    sigma: f64,
}

/// One method in a setting at one number of samples.
#[derive(Debug)]
struct ForeignCell {
    /// Index of its setting.
    setting: usize,
    estimator: Arc<dyn ForeignEstimator>,
    is_paired: bool,
    design: Design,
    controls: ControlPlan,
    spec: CellSpec,
    /// The bound, where the model holds.
    bound: Option<Vec<f64>>,
}

/// What a replicate gave in a cell.
struct Answered {
    controls: Vec<f64>,
    own: Result<Estimates, String>,
    /// Nothing where none was asked for.
    partner: Option<Result<Estimates, String>>,
}

/// Lays out the noise groups; `before` are the groups of our methods, with their cells.
///
/// With shared noise all use the streams of the pulse methods; with independent noise each cell has its own, behind theirs.
pub(super) fn plan(
    scenario: &Scenario,
    estimators: &[Arc<dyn ForeignEstimator>],
    (groups, cells): (usize, usize),
) -> Result<Vec<ForeignNoiseGroup>, StudyError> {
    let mut planned = Vec::new();
    let mut first_cell = cells;
    if scenario.foreign().is_empty() {
        return Ok(planned);
    }
    for case in scenario.cases() {
        let all = Cells::of(scenario, case, estimators)?;
        match scenario.coupling() {
            Coupling::Shared => planned.push(all.group(case, 0, first_cell)),
            Coupling::Independent => {
                for alone in all.apart() {
                    let stream = STREAMS * (groups + planned.len()) as u32;
                    planned.push(alone.group(case, stream, first_cell));
                    first_cell += 1;
                }
                continue;
            }
        }
        first_cell += planned.last().map_or(0, |group| group.cells.len());
    }
    Ok(planned)
}

/// Settings and cells that are to make a group.
struct Cells {
    settings: Vec<Setting>,
    cells: Vec<ForeignCell>,
}

impl Cells {
    /// All cells of a case, in the order of the results: setting, number of samples, method.
    fn of(
        scenario: &Scenario,
        case: &Case,
        estimators: &[Arc<dyn ForeignEstimator>],
    ) -> Result<Self, StudyError> {
        let sweep = scenario.sweep();
        let mut all = Self { settings: Vec::new(), cells: Vec::new() };
        for border in &case.borders {
            for &points in &sweep.points {
                let setup = Setup::new(case, border, points)?;
                for &sigma in &sweep.noise {
                    let series = |method: &ForeignMethod| Series {
                        case: case.name.clone(),
                        border: border.name.clone(),
                        method: MethodName::Foreign(method.name.clone()),
                        points,
                        noise: sigma,
                    };
                    for &samples in &sweep.samples {
                        for (method, estimator) in scenario.foreign().iter().zip(estimators) {
                            let of = (case, &setup, sigma, samples);
                            let cell = ForeignCell::new(of, method, series(method), Arc::clone(estimator));
                            all.cells.push(ForeignCell { setting: all.settings.len(), ..cell });
                        }
                    }
                    all.settings.push(Setting { setup: setup.clone(), sigma });
                }
            }
        }
        Ok(all)
    }

    /// Each cell for itself.
    fn apart(self) -> impl Iterator<Item = Self> {
        let Self { settings, cells } = self;
        cells.into_iter().map(move |cell| {
            let Setting { setup, sigma } = &settings[cell.setting];
            let settings = vec![Setting { setup: setup.clone(), sigma: *sigma }];
            Self { settings, cells: vec![ForeignCell { setting: 0, ..cell }] }
        })
    }

    fn group(mut self, case: &Case, stream: u32, first_cell: usize) -> ForeignNoiseGroup {
        let filter = NoiseFilter::of(case);
        let burn_in = filter.burn_in();
        let longest = self.cells.iter().map(|cell| cell.spec.samples).max().unwrap_or(1);
        for (k, cell) in self.cells.iter_mut().enumerate() {
            cell.design.cell = first_cell + k;
        }
        let noise = NoisePlan {
            ar: filter.ar,
            ma: filter.ma,
            lags: case.order,
            periods: Vec::new(),
            checkpoints: vec![longest],
            burn_in,
        };
        ForeignNoiseGroup { stream, noise, first_cell, cells: self.cells, settings: self.settings }
    }
}

impl ForeignCell {
    fn new(
        (case, setup, sigma, samples): (&Case, &Setup, f64, usize),
        method: &ForeignMethod,
        series: Series,
        estimator: Arc<dyn ForeignEstimator>,
    ) -> Self {
        let borders = [(Group::Descending, setup.levels(0)), (Group::Ascending, setup.levels(1))];
        let all = ParameterName::all(case.order, &borders);
        let is_asked = |name: &&ParameterName| method.groups.contains(&name.group);
        let chosen = |values: Vec<f64>| -> Vec<f64> {
            all.iter().zip(values).filter(|(name, _)| is_asked(name)).map(|(_, value)| value).collect()
        };
        let parameters: Vec<ParameterName> = all.iter().filter(is_asked).cloned().collect();
        let holds = case.disturbance == Disturbance::White && setup.has_the_model(case);
        let bound = holds.then(|| setup.bound(PulseKind::Joint, sigma, samples).ok()).flatten();
        Self {
            setting: 0,
            estimator,
            is_paired: method.antithetic,
            design: design(case, setup, samples, &parameters),
            controls: ControlPlan::new(setup.period(), samples, case.order),
            bound: bound.map(chosen),
            spec: CellSpec { series, samples, truth: chosen(setup.truth(PulseKind::Joint)), parameters },
        }
    }

    fn shape(&self) -> ControlShape {
        self.controls.shape(self.spec.parameters.len(), self.is_paired)
    }
}

/// What may be known of the records of a cell.
fn design(case: &Case, setup: &Setup, samples: usize, parameters: &[ParameterName]) -> Design {
    let experiment = |k: usize| DesignExperiment {
        direction: DIRECTIONS[k],
        levels: setup.levels(k).to_vec(),
        satellite: setup.satellite(k),
        lead: setup.lead(),
        v: setup.periodic_input(k, samples),
    };
    let interval = case.interval();
    Design {
        cell: 0,
        order: case.order,
        points: setup.points,
        samples,
        interval: [interval.low(), interval.high()],
        parameters: parameters.iter().map(|parameter| parameter.name.clone()).collect(),
        experiments: [0, 1].map(experiment),
    }
}

impl ForeignNoiseGroup {
    /// What tables and verdicts need of the cells.
    pub(super) fn specs(&self) -> impl Iterator<Item = CellSpec> {
        self.cells.iter().map(|cell| cell.spec.clone())
    }

    /// What the sums of the cells hold of controls.
    pub(super) fn shapes(&self) -> impl Iterator<Item = ControlShape> {
        self.cells.iter().map(ForeignCell::shape)
    }

    /// What is known of the cells without any replicate.
    pub(super) fn theories(&self) -> impl Iterator<Item = CellTheory> {
        self.cells.iter().map(|cell| CellTheory {
            bound: cell.bound.clone(),
            controls: Some((cell.controls.clone(), self.noise.clone())),
            ..CellTheory::default()
        })
    }

    /// The records of one replicate in a cell, by its place among all; `None` where it belongs to another group.
    pub(super) fn records(
        &self,
        cell: usize,
        seed: u64,
        replicate: u32,
    ) -> Option<[(Vec<f64>, Vec<f64>); 2]> {
        let cell = self.cells.get(cell.checked_sub(self.first_cell)?)?;
        let Setting { setup, sigma } = &self.settings[cell.setting];
        let noise = self.draw(seed, replicate);
        let v = cell.design.experiments.each_ref().map(|e| e.v.clone());
        let y = outputs(setup, *sigma, &noise, cell.spec.samples);
        let ([v0, v1], [y0, y1]) = (v, y);
        Some([(v0, y0), (v1, y1)])
    }

    fn draw(&self, seed: u64, replicate: u32) -> [NoiseSamples; 2] {
        let count = self.noise.checkpoints[0];
        [0, 1].map(|k| {
            let id = StreamId { seed, experiment: self.stream + k, replicate };
            samples(&self.noise, id, count).expect("a group's noise plan is valid")
        })
    }

    /// The errors of some replicates: one entry a cell, with one a replicate.
    pub(super) fn errors(&self, seed: u64, replicates: Range<u32>) -> Vec<Vec<ReplicateErrors>> {
        let answers = self.answers(seed, replicates, &vec![true; self.cells.len()]);
        let of_cell = |(cell, answers): (&ForeignCell, Vec<Answered>)| {
            answers.into_iter().map(|answered| cell.errors(answered)).collect()
        };
        self.cells.iter().zip(answers).map(of_cell).collect()
    }

    /// Some replicates of all active cells: one entry a cell, with one a replicate.
    fn answers(&self, seed: u64, replicates: Range<u32>, active: &[bool]) -> Vec<Vec<Answered>> {
        let noise: Vec<[NoiseSamples; 2]> = replicates.clone().map(|r| self.draw(seed, r)).collect();
        let mut all: Vec<Vec<Answered>> = self.cells.iter().map(|_| Vec::new()).collect();
        for (index, Setting { setup, sigma }) in self.settings.iter().enumerate() {
            let of_setting = |k: &usize| self.cells[*k].setting == index && active[*k];
            let own: Vec<usize> = (0..self.cells.len()).filter(of_setting).collect();
            let longest = own.iter().map(|&k| self.cells[k].spec.samples).max();
            let Some(longest) = longest else { continue };
            let is_paired = own.iter().any(|&k| self.cells[k].is_paired);
            let signs: &[f64] = if is_paired { &[1.0, -1.0] } else { &[1.0] };
            let y: Vec<Vec<[Vec<f64>; 2]>> = signs
                .iter()
                .map(|sign| noise.iter().map(|noise| outputs(setup, sign * sigma, noise, longest)).collect())
                .collect();
            for k in own {
                all[k] = self.cells[k].answers(replicates.start, &noise, &y);
            }
        }
        all
    }
}

impl ForeignCell {
    /// Has the records of some replicates estimated, by sign of the noise.
    fn answers(&self, first: u32, noise: &[[NoiseSamples; 2]], y: &[Vec<[Vec<f64>; 2]>]) -> Vec<Answered> {
        let signs = if self.is_paired { y } else { &y[..1] };
        let lengths = self.design.experiments.each_ref().map(|e| e.v.len());
        let records: Vec<Records<'_>> = (0..noise.len())
            .flat_map(|r| signs.iter().enumerate().map(move |(sign, y)| (r, sign, &y[r])))
            .map(|(r, sign, y)| Records {
                replicate: first + r as u32,
                antithetic: sign == 1,
                y: [0, 1].map(|k| &y[k][..lengths[k]]),
            })
            .collect();
        let mut results = self.estimator.estimate(&self.design, &records).into_iter();
        let unanswered = || Err("there was no answer".to_owned());
        let answered = |noise: &[NoiseSamples; 2]| Answered {
            controls: self.controls.values(noise),
            own: results.next().unwrap_or_else(unanswered),
            partner: self.is_paired.then(|| results.next().unwrap_or_else(unanswered)),
        };
        noise.iter().map(answered).collect()
    }

    fn errors(&self, answered: Answered) -> ReplicateErrors {
        let errors = |found: Result<Estimates, String>| -> Result<Vec<f64>, String> {
            Ok(found?.iter().zip(&self.spec.truth).map(|((value, _), truth)| value - truth).collect())
        };
        ReplicateErrors { own: errors(answered.own), partner: answered.partner.map(errors) }
    }

    /// Adds what a replicate gave.
    fn add(&self, replicate: u32, answered: &Answered, sums: &mut CellSums) {
        let errors = |estimates: &Estimates| -> Vec<f64> {
            estimates.iter().zip(&self.spec.truth).map(|((value, _), truth)| value - truth).collect()
        };
        let own = answered.own.as_ref().ok().map(errors);
        let partner = answered.partner.as_ref().and_then(|partner| partner.as_ref().ok()).map(errors);
        let at = section(replicate as usize);
        let se = answered
            .own
            .as_ref()
            .ok()
            .map(|estimates| estimates.iter().map(|(_, se)| *se).collect::<Vec<_>>());
        let pair = PairOfErrors { own: own.as_deref(), se: se.as_deref(), partner: partner.as_deref() };
        sums.push_controls(at, &answered.controls, pair);
        let mut alone = sums.section(at);
        alone.runs.replicates = 1;
        match (&answered.own, own) {
            (Ok(estimates), Some(errors)) => {
                for (k, (error, (_, se))) in errors.into_iter().zip(estimates).enumerate() {
                    let (first_order, second_order, first_order_variance) = (None, 0.0, None);
                    let replicate =
                        ReplicateError { error, se: *se, first_order, second_order, first_order_variance };
                    alone.push_parameter(k, replicate);
                }
            }
            (Err(reason), _) => alone.runs.fail(replicate, reason.clone()),
            (Ok(_), None) => {}
        }
        sums.put_section(at, &alone);
    }
}

/// `y = z + σe` of both experiments, with the samples before `t = 0` that estimators see.
fn outputs(setup: &Setup, sigma: f64, noise: &[NoiseSamples; 2], samples: usize) -> [Vec<f64>; 2] {
    [0, 1].map(|k| {
        let NoiseSamples { e, burn_in, .. } = &noise[k];
        let z = setup.response(k);
        let lead = setup.lead();
        // Before the noise begins there is none.
        let rest = lead.saturating_sub(*burn_in);
        let e = std::iter::repeat_n(&0.0, rest).chain(&e[burn_in + rest - lead..]);
        let z = z.iter().cycle().skip(z.len() - lead % z.len());
        z.zip(e).take(lead + samples).map(|(z, e)| z + sigma * e).collect()
    })
}

impl Workload for ForeignNoiseGroup {
    fn cells(&self) -> usize {
        self.cells.len()
    }

    /// One task, which asks for a few replicates a thread and adds up what came in their order.
    fn take_in<'a>(&'a self, chunk: Chunk<'a>, cells: ActiveCells<'a>) -> Vec<Task<'a>> {
        vec![Box::new(move |_| {
            let ActiveCells { active, sums } = cells;
            let Range { start, end } = chunk.range.start as u32..chunk.range.end as u32;
            let handful =
                (end - start).div_ceil(rayon::current_num_threads() as u32).clamp(1, HANDFUL as u32);
            let firsts: Vec<u32> = (start..end).step_by(handful as usize).collect();
            let answers: Vec<Vec<Vec<Answered>>> = firsts
                .par_iter()
                .map(|&first| self.answers(chunk.seed, first..end.min(first + handful), active))
                .collect();
            for (first, answers) in firsts.iter().zip(&answers) {
                for ((cell, answers), sums) in self.cells.iter().zip(answers).zip(&mut *sums) {
                    for (replicate, answered) in (*first..).zip(answers) {
                        cell.add(replicate, answered, sums);
                    }
                }
            }
        })]
    }
}
