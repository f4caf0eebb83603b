//! The cells of one case, which share the noise of a replicate.

use super::cell_design::{
    Analysis, CellDesign, GridOnDrive, NoiseSums, Regressions, RequestedFaults, Response,
};
use super::drive::{self, Program};
use super::simulate::Simulator;
use crate::consistency::cell::{ActiveCells, CellSpec, CellTheory};
use crate::consistency::error::StudyError;
use crate::consistency::sections::SectionSums;
use crate::consistency::setup::NoiseFilter;
use crate::consistency::workload::{Chunk, Task, Workload, one_by_one};
use crate::scenario::{Case, Engine, Fit, Knots, Sweep};
use nalgebra::DMatrix;
use std::cell::RefCell;
use std::collections::BTreeMap;
use switchback_identify::Estimate;
use switchback_identify::free::{Basis, FitKind, Moments, NestedRegressions, Output, Regression};
use switchback_identify::statistics::ReplicateError;
use switchback_noise::{NoisePlan, NoiseSamples, StreamId, samples};

/// What all noise groups of a scenario have in common.
#[derive(Debug, Clone, Copy)]
pub(super) struct Design {
    pub(super) program: Program,
    pub(super) engine: Engine,
}

/// Everything that the noise of one replicate serves.
#[derive(Debug)]
pub(in crate::consistency) struct FreeNoiseGroup {
    stream: u32,
    noise: NoisePlan,
    case: Case,
    /// `v(t)`.
    drive: Vec<f64>,
    /// The samples after which it starts over.
    period: usize,
    checkpoints: usize,
    responses: Vec<Response>,
    grids: Vec<GridOnDrive>,
    cell_designs: Vec<CellDesign>,
    /// The direct engine's, which simulates every setting on its own.
    simulator: Option<Simulator>,
}

impl FreeNoiseGroup {
    /// Every border, number of knots and noise level of a case.
    pub(super) fn new(case: &Case, sweep: &Sweep, stream: u32, of: Design) -> Result<Self, StudyError> {
        let Design { program, engine } = of;
        let interval = case.interval();
        let longest = sweep.samples.last().copied().unwrap_or_default();
        let v = drive::input(interval, program, case.order, longest);
        let grids: Vec<GridOnDrive> = sweep
            .points
            .iter()
            .map(|&points| {
                let refusal = |reason| StudyError::NoExperiment { case: case.name.clone(), points, reason };
                if points < 2 {
                    return Err(refusal(
                        "free needs two knots or more a border; raise sweep.points".to_owned(),
                    ));
                }
                let grid = drive::grid(interval, points, case.order);
                let regressions = match case.knots {
                    Knots::Given => Regression::new(&v, grid.clone(), &sweep.samples)
                        .map(|regression| Regressions::Given(Box::new(regression))),
                    Knots::Refined | Knots::Known => {
                        NestedRegressions::new(&v, grid.clone(), &sweep.samples).map(Regressions::Nested)
                    }
                };
                let regressions = regressions.map_err(|error| refusal(format!("free: {error}")))?;
                Ok(GridOnDrive { points, grid, regressions })
            })
            .collect::<Result<_, _>>()?;
        let responses: Vec<Response> = case
            .borders
            .iter()
            .map(|border| {
                let z = drive::response(case, border, &v);
                Response { lags: grids[0].regressions.all()[0].lag_products(&z, &z), z }
            })
            .collect();
        let mut cell_designs = Vec::new();
        for (b, border) in case.borders.iter().enumerate() {
            for (g, grid) in grids.iter().enumerate() {
                for &sigma in &sweep.noise {
                    let of = RequestedFaults { case, border, v: &v, samples: &sweep.samples };
                    cell_designs.push(CellDesign::new(of, (b, &responses[b]), (g, grid), sigma)?);
                }
            }
        }
        let filter = NoiseFilter::of(case);
        let burn_in = filter.burn_in();
        let noise = NoisePlan {
            ar: filter.ar,
            ma: filter.ma,
            lags: case.order,
            periods: Vec::new(),
            checkpoints: sweep.samples.clone(),
            burn_in,
        };
        Ok(Self {
            stream,
            noise,
            checkpoints: sweep.samples.len(),
            responses,
            grids,
            cell_designs,
            simulator: (engine == Engine::Direct).then(|| Simulator::new(case, &v)),
            case: case.clone(),
            drive: v,
            period: program.period,
        })
    }

    /// What tables and verdicts need of the cells: settings in order, each by increasing `N`.
    pub(in crate::consistency) fn specs(&self) -> impl Iterator<Item = CellSpec> {
        self.cell_designs.iter().flat_map(|cell_design| cell_design.specs.iter().cloned())
    }

    /// What theory says of the cells, in the same order.
    pub(in crate::consistency) fn theories(&self) -> impl Iterator<Item = CellTheory> {
        self.cell_designs.iter().flat_map(|cell_design| cell_design.theories.iter().cloned())
    }

    fn replicate(&self, seed: u64, replicate: u32, active: &[bool], sums: &mut [SectionSums]) {
        let noise = self.draw(seed, replicate);
        let shared = self.simulator.is_none().then(|| Noise::new(self, &noise));
        let cells = active.chunks(self.checkpoints).zip(sums.chunks_mut(self.checkpoints));
        for (cell_design, (active, sums)) in self.cell_designs.iter().zip(cells) {
            let record = self.simulator.as_ref().map(|simulator| Record {
                y: simulator.output(cell_design.response, cell_design.sigma, &noise),
                sums: RefCell::default(),
            });
            let open = (self.kind().is_some() && record.is_none()).then(|| {
                let z = &self.responses[cell_design.response].z;
                z.iter()
                    .zip(&noise.e[noise.burn_in..])
                    .map(|(z, e)| z + cell_design.sigma * e)
                    .collect::<Vec<_>>()
            });
            for (checkpoint, sums) in sums.iter_mut().enumerate().filter(|(c, _)| active[*c]) {
                let moments = |number: usize| {
                    let regression = (number, &self.grids[cell_design.grid].regressions.all()[number]);
                    match (&record, &shared) {
                        (None, Some(shared)) => {
                            let noise = shared.sums(cell_design, number, checkpoint);
                            cell_design.moments(
                                regression,
                                &self.responses[cell_design.response],
                                checkpoint,
                                noise,
                            )
                        }
                        (Some(record), _) => record.moments(regression, checkpoint),
                        (None, None) => unreachable!("either engine has its noise"),
                    }
                };
                let open = open.as_ref().or(record.as_ref().map(|record| &record.y));
                let output = open.zip(self.kind()).map(|(y, kind)| Output {
                    y,
                    checkpoint,
                    // The direct engine simulates and fits every sample.
                    period: self.simulator.is_none().then_some(self.period),
                    kind,
                });
                self.estimate((cell_design, checkpoint), (moments, output), replicate, sums);
            }
        }
    }

    /// The record of one replicate in a cell of the group: `v(t)` and `y(t)`.
    pub(in crate::consistency) fn record(
        &self,
        cell: usize,
        seed: u64,
        replicate: u32,
    ) -> (Vec<f64>, Vec<f64>) {
        let cell_design = &self.cell_designs[cell / self.checkpoints];
        let simulator = Simulator::new(&self.case, &self.drive);
        let mut y = simulator.output(cell_design.response, cell_design.sigma, &self.draw(seed, replicate));
        // The first rows are lags of those that count.
        let rows = cell_design.specs[cell % self.checkpoints].samples + self.case.order;
        y.truncate(rows);
        (self.drive[..y.len()].to_vec(), y)
    }

    /// What fits of the free run make least; none where the equation error is.
    fn kind(&self) -> Option<FitKind> {
        match self.case.fit {
            Fit::Equation => None,
            Fit::FreeRun => Some(FitKind::Simulation),
            Fit::Prewhitened => Some(FitKind::Prewhitened),
        }
    }

    fn draw(&self, seed: u64, replicate: u32) -> NoiseSamples {
        samples(&self.noise, StreamId { seed, experiment: self.stream, replicate }, self.drive.len())
            .expect("a group's noise plan is valid")
    }

    fn estimate(
        &self,
        (cell_design, checkpoint): (&CellDesign, usize),
        (moments, output): (impl Fn(usize) -> Moments, Option<Output<'_>>),
        replicate: u32,
        sums: &mut SectionSums,
    ) {
        let on = &self.grids[cell_design.grid];
        let regressions = on.regressions.all();
        sums.runs.replicates += 1;
        let (estimate, first_order) = match (&cell_design.analyses[checkpoint], &on.regressions) {
            (Analysis::Given(limit), _) => {
                if let Some(output) = output {
                    (regressions[0].free_run_estimate(output, &moments(0)), None)
                } else {
                    let moments = moments(0);
                    (regressions[0].estimate(&moments), Some(limit.first_order(&moments)))
                }
            }
            (Analysis::Known(number), _) => (regressions[*number].estimate(&moments(*number)), None),
            (Analysis::Refined, Regressions::Nested(nested)) => match output {
                Some(output) => (nested.free_run_estimate(output, moments), None),
                None => (nested.estimate(moments), None),
            },
            (Analysis::Refined, Regressions::Given(_)) => unreachable!("a grid that is refined is nested"),
        };
        match estimate.map(|estimate| at_knots(estimate, &on.grid.basis)) {
            Ok(estimate) if parameters(&estimate).all(|(x, se)| x.is_finite() && se.is_finite()) => {
                let truth = &cell_design.specs[checkpoint].truth;
                for (k, (value, se)) in parameters(&estimate).enumerate() {
                    let first_order = first_order.as_ref().map(|first| first[k]);
                    let error = value - truth[k];
                    let (second_order, first_order_variance) = (0.0, None);
                    sums.push_parameter(
                        k,
                        ReplicateError { error, se, first_order, second_order, first_order_variance },
                    );
                }
            }
            Ok(_) => sums.runs.fail(replicate, "the record leaves a parameter open".to_owned()),
            Err(error) => sums.runs.fail(replicate, error.to_string()),
        }
    }
}

impl Workload for FreeNoiseGroup {
    fn cells(&self) -> usize {
        self.cell_designs.len() * self.checkpoints
    }

    fn take_in<'a>(&'a self, chunk: Chunk<'a>, cells: ActiveCells<'a>) -> Vec<Task<'a>> {
        one_by_one(chunk, cells, |seed, replicate, active, sums| {
            self.replicate(seed, replicate, active, sums)
        })
    }
}

/// The estimate at the knots of the sweep alone.
fn at_knots(mut estimate: Estimate, basis: &Basis) -> Estimate {
    estimate.descending.retain(|point| basis.descending().contains(&point.v));
    estimate.ascending.retain(|point| basis.ascending().contains(&point.v));
    estimate
}

/// An output, and its sums for the regressions that were asked for.
#[derive(Debug)]
struct Record {
    y: Vec<f64>,
    /// By number of the regression: the moments at each checkpoint.
    sums: RefCell<BTreeMap<usize, Vec<Moments>>>,
}

impl Record {
    /// The moments of the record at a checkpoint, summed from it.
    fn moments(&self, (number, regression): (usize, &Regression), checkpoint: usize) -> Moments {
        let mut sums = self.sums.borrow_mut();
        let all = sums.entry(number).or_insert_with(|| {
            let (lags, input) =
                (regression.lag_products(&self.y, &self.y), regression.input_products(&self.y));
            (0..lags.len()).map(|c| regression.moments(c, &lags[c], &input[c])).collect()
        });
        all[checkpoint].clone()
    }
}

/// Values and standard errors in the order of the parameters' names.
fn parameters(estimate: &Estimate) -> impl Iterator<Item = (f64, f64)> {
    let coefficients = |values: &[f64], errors: &[f64]| {
        values.iter().copied().zip(errors.iter().copied()).collect::<Vec<_>>()
    };
    let points = estimate.descending.iter().chain(&estimate.ascending).map(|p| (p.f, p.se));
    coefficients(&estimate.a, &estimate.a_se)
        .into_iter()
        .chain(coefficients(&estimate.b, &estimate.b_se))
        .chain(points)
}

/// All sums that the unit noise of one replicate enters, by checkpoint.
struct Noise {
    lags: Vec<DMatrix<f64>>,
    /// With each response.
    cross: Vec<Vec<DMatrix<f64>>>,
    /// With the regressors of each grid's regressions.
    input: Vec<Vec<Vec<DMatrix<f64>>>>,
}

impl Noise {
    fn new(group: &FreeNoiseGroup, noise: &NoiseSamples) -> Self {
        let e = &noise.e[noise.burn_in..];
        // Lag products depend on the rows alone, which every grid shares.
        let input = |g: &GridOnDrive| g.regressions.all().iter().map(|r| r.input_products(e)).collect();
        let rows = &group.grids[0].regressions.all()[0];
        Self {
            lags: rows.lag_products(e, e),
            cross: group.responses.iter().map(|r| rows.lag_products(&r.z, e)).collect(),
            input: group.grids.iter().map(input).collect(),
        }
    }

    fn sums(&self, cell_design: &CellDesign, number: usize, checkpoint: usize) -> NoiseSums<'_> {
        NoiseSums {
            lags: &self.lags[checkpoint],
            cross: &self.cross[cell_design.response][checkpoint],
            input: &self.input[cell_design.grid][number][checkpoint],
        }
    }
}
