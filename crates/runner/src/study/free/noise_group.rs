//! The cells of one case, which share the noise of a replicate.

use super::drive::{self, Program};
use super::setting::{GridOnDrive, Ingredients, NoiseSums, Response, Setting};
use super::simulate::Simulator;
use crate::scenario::{Case, Engine, Sweep};
use crate::study::StudyError;
use crate::study::bench::NoiseFilter;
use crate::study::cell::{ActiveCells, CellSpec};
use crate::study::sections::CellSums;
use crate::study::workload::{Chunk, Task, Workload, one_by_one};
use nalgebra::DMatrix;
use switchback_estimator::estimators::Estimate;
use switchback_estimator::estimators::free::{Moments, Regression};
use switchback_estimator::simulation::noise::{NoisePlan, NoiseSamples, StreamId, samples};
use switchback_estimator::statistics::ReplicateError;

/// What all noise groups of a scenario have in common.
#[derive(Debug, Clone, Copy)]
pub(super) struct Design {
    pub(super) program: Program,
    pub(super) engine: Engine,
}

/// Everything that the noise of one replicate serves.
#[derive(Debug)]
pub(in crate::study) struct FreeNoiseGroup {
    stream: u32,
    noise: NoisePlan,
    /// Samples of the drive.
    length: usize,
    checkpoints: usize,
    responses: Vec<Response>,
    grids: Vec<GridOnDrive>,
    settings: Vec<Setting>,
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
                let regression = Regression::new(&v, grid.clone(), &sweep.samples)
                    .map_err(|error| refusal(format!("free: {error}")))?;
                Ok(GridOnDrive { points, grid, regression })
            })
            .collect::<Result<_, _>>()?;
        let responses: Vec<Response> = case
            .borders
            .iter()
            .map(|border| {
                let z = drive::response(case, border, &v);
                Response { lags: grids[0].regression.lag_products(&z, &z), z }
            })
            .collect();
        let mut settings = Vec::new();
        for (b, border) in case.borders.iter().enumerate() {
            for (g, grid) in grids.iter().enumerate() {
                for &sigma in &sweep.noise {
                    let of = Ingredients { case, border, v: &v, samples: &sweep.samples };
                    settings.push(Setting::new(of, (b, &responses[b]), (g, grid), sigma)?);
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
            length: v.len(),
            checkpoints: sweep.samples.len(),
            responses,
            grids,
            settings,
            simulator: (engine == Engine::Direct).then(|| Simulator::new(case, &v)),
        })
    }

    /// What tables and verdicts need of the cells: settings in order, each by increasing `N`.
    pub(in crate::study) fn specs(&self) -> impl Iterator<Item = CellSpec> {
        self.settings.iter().flat_map(|setting| setting.specs.iter().cloned())
    }

    fn replicate(&self, seed: u64, replicate: u32, active: &[bool], sums: &mut [CellSums]) {
        let noise = samples(&self.noise, StreamId { seed, experiment: self.stream, replicate }, self.length)
            .expect("a group's noise plan is valid");
        let shared = self.simulator.is_none().then(|| Noise::new(self, &noise));
        let cells = active.chunks(self.checkpoints).zip(sums.chunks_mut(self.checkpoints));
        for (setting, (active, sums)) in self.settings.iter().zip(cells) {
            let moments = match (&self.simulator, &shared) {
                (Some(simulator), _) => {
                    self.of_record(setting, &simulator.output(setting.response, setting.sigma, &noise))
                }
                (None, shared) => {
                    let of = |c| Some(self.superposed(setting, c, shared.as_ref()?.sums(setting, c)));
                    (0..self.checkpoints).filter_map(of).collect()
                }
            };
            for (checkpoint, moments) in moments.iter().enumerate().filter(|(c, _)| active[*c]) {
                self.estimate((setting, checkpoint), moments, replicate, &mut sums[checkpoint]);
            }
        }
    }

    /// The moments of a record at every checkpoint, summed from it.
    fn of_record(&self, setting: &Setting, y: &[f64]) -> Vec<Moments> {
        let regression = &self.grids[setting.grid].regression;
        let (lags, input) = (regression.lag_products(y, y), regression.input_products(y));
        (0..self.checkpoints).map(|c| regression.moments(c, &lags[c], &input[c])).collect()
    }

    /// The moments at a checkpoint, by superposition.
    fn superposed(&self, setting: &Setting, checkpoint: usize, noise: NoiseSums<'_>) -> Moments {
        let regression = &self.grids[setting.grid].regression;
        setting.moments(regression, &self.responses[setting.response], checkpoint, noise)
    }

    fn estimate(
        &self,
        (setting, checkpoint): (&Setting, usize),
        moments: &Moments,
        replicate: u32,
        sums: &mut CellSums,
    ) {
        let regression = &self.grids[setting.grid].regression;
        sums.replicates += 1;
        match regression.estimate(moments) {
            Ok(estimate) if parameters(&estimate).all(|(x, se)| x.is_finite() && se.is_finite()) => {
                let first_order = setting.limits[checkpoint].first_order(moments);
                let truth = &setting.specs[checkpoint].truth;
                for ((((value, se), first), truth), sums) in
                    parameters(&estimate).zip(first_order).zip(truth).zip(&mut sums.parameters)
                {
                    sums.push(ReplicateError {
                        error: value - truth,
                        se,
                        first_order: Some(first),
                        second_order: 0.0,
                    });
                }
            }
            Ok(_) => sums.fail(replicate, "the record leaves a parameter open".to_owned()),
            Err(error) => sums.fail(replicate, error.to_string()),
        }
    }
}

impl Workload for FreeNoiseGroup {
    fn cells(&self) -> usize {
        self.settings.len() * self.checkpoints
    }

    fn take_in<'a>(&'a self, chunk: Chunk<'a>, cells: ActiveCells<'a>) -> Vec<Task<'a>> {
        one_by_one(chunk, cells, |seed, replicate, active, sums| {
            self.replicate(seed, replicate, active, sums)
        })
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
    /// With each grid's regressors.
    input: Vec<Vec<DMatrix<f64>>>,
}

impl Noise {
    fn new(group: &FreeNoiseGroup, noise: &NoiseSamples) -> Self {
        let e = &noise.e[noise.burn_in..];
        // Lag products depend on the rows alone, which every grid shares.
        let rows = &group.grids[0].regression;
        Self {
            lags: rows.lag_products(e, e),
            cross: group.responses.iter().map(|r| rows.lag_products(&r.z, e)).collect(),
            input: group.grids.iter().map(|g| g.regression.input_products(e)).collect(),
        }
    }

    fn sums(&self, setting: &Setting, checkpoint: usize) -> NoiseSums<'_> {
        NoiseSums {
            lags: &self.lags[checkpoint],
            cross: &self.cross[setting.response][checkpoint],
            input: &self.input[setting.grid][checkpoint],
        }
    }
}
