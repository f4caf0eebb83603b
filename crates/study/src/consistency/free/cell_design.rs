//! One border, grid and noise level: everything about its cells that noise does not touch.

use super::drive;
use crate::consistency::cell::{CellSpec, CellTheory, ParameterName};
use crate::consistency::error::StudyError;
use crate::consistency::setup::NoiseFilter;
use crate::results::{Group, Series};
use crate::scenario::{Border, Case, Disturbance, Fit, Knots};
use nalgebra::DMatrix;
use switchback_identify::Method;
use switchback_identify::free::{FitKind, Grid, Limit, Moments, NestedRegressions, Output, Regression};
use switchback_model::linear::autocovariance;

/// A grid and the drive's regression on it.
#[derive(Debug)]
pub(super) struct GridOnDrive {
    pub(super) points: usize,
    pub(super) grid: Grid,
    pub(super) regressions: Regressions,
}

/// The regressions that estimates on a grid may take.
#[derive(Debug)]
pub(super) enum Regressions {
    /// On the grid itself.
    Given(Box<Regression>),
    /// On its halvings, too.
    Nested(NestedRegressions),
}

impl Regressions {
    /// All of them; the first is that on the grid itself.
    pub(super) fn all(&self) -> &[Regression] {
        match self {
            Self::Given(regression) => std::slice::from_ref(regression),
            Self::Nested(nested) => nested.regressions(),
        }
    }
}

/// How a cell is estimated.
#[derive(Debug)]
pub(super) enum Analysis {
    /// On the grid itself, with the limit there.
    Given(Box<Limit>),
    /// On the grid that the record asks for.
    Refined,
    /// On the grid of the regression of this number, which holds the truth.
    Known(usize),
}

/// A border's noise-free output and its lag products at each checkpoint.
#[derive(Debug)]
pub(super) struct Response {
    pub(super) z: Vec<f64>,
    pub(super) lags: Vec<DMatrix<f64>>,
}

/// The cells over `N` of one border, grid and noise level.
#[derive(Debug)]
pub(super) struct CellDesign {
    /// Index of the border's response.
    pub(super) response: usize,
    /// Index of the grid.
    pub(super) grid: usize,
    pub(super) sigma: f64,
    /// Sums of the noise-free output against the input's regressors, for each regression at each checkpoint.
    input: Vec<Vec<DMatrix<f64>>>,
    /// One a checkpoint.
    pub(super) analyses: Vec<Analysis>,
    /// One a checkpoint.
    pub(super) specs: Vec<CellSpec>,
    /// One a checkpoint.
    pub(super) theories: Vec<CellTheory>,
}

/// What a setting is made of.
#[derive(Debug, Clone, Copy)]
pub(super) struct RequestedFaults<'a> {
    pub(super) case: &'a Case,
    pub(super) border: &'a Border,
    pub(super) v: &'a [f64],
    pub(super) samples: &'a [usize],
}

/// Sums of the unit noise of one replicate at one checkpoint.
#[derive(Debug, Clone, Copy)]
pub(super) struct NoiseSums<'a> {
    /// `Σ e(t−i) e(t−l)`
    pub(super) lags: &'a DMatrix<f64>,
    /// `Σ z(t−i) e(t−l)`
    pub(super) cross: &'a DMatrix<f64>,
    /// `Σ e(t−i) ψ(t)`
    pub(super) input: &'a DMatrix<f64>,
}

impl CellDesign {
    /// Works out truth, limit, theory and bound at every checkpoint; `response` and `grid` are given with their indices.
    pub(super) fn new(
        of: RequestedFaults<'_>,
        (response_index, response): (usize, &Response),
        (grid_index, on): (usize, &GridOnDrive),
        sigma: f64,
    ) -> Result<Self, StudyError> {
        let mut cell_design = Self {
            response: response_index,
            grid: grid_index,
            sigma,
            input: on.regressions.all().iter().map(|r| r.input_products(&response.z)).collect(),
            analyses: Vec::new(),
            specs: Vec::new(),
            theories: Vec::new(),
        };
        let holds = keeps_assumptions(of.case) && drive::lies_on(&of.border.hysteresis, &on.grid, of.v);
        for (checkpoint, &samples) in of.samples.iter().enumerate() {
            let at = Place { checkpoint, samples };
            let analysis = cell_design.analysis(of, (response, on), at)?;
            // Least squares and rank one on white errors is maximum likelihood: its theory is the bound.
            let theory = match &analysis {
                Analysis::Given(limit) if of.case.fit == Fit::Equation => holds.then(|| limit.theory_se()),
                Analysis::Given(_) => cell_design.free_run_bound(of, (response, on), at),
                Analysis::Refined | Analysis::Known(_) => None,
            };
            let is_efficient = match of.case.fit {
                Fit::Equation | Fit::Prewhitened => true,
                Fit::FreeRun => of.case.disturbance == Disturbance::Output,
            };
            cell_design.analyses.push(analysis);
            cell_design.specs.push(CellSpec {
                series: Series {
                    case: of.case.name.clone(),
                    border: of.border.name.clone(),
                    method: Method::Free.into(),
                    points: on.points,
                    noise: sigma,
                },
                samples,
                parameters: names(of.case.order, &on.grid),
                truth: truth(of.case, of.border, &on.grid),
            });
            cell_design.theories.push(CellTheory {
                sd: theory.clone().filter(|_| is_efficient),
                bound: theory,
                ..CellTheory::default()
            });
        }
        Ok(cell_design)
    }

    /// The Cramér–Rao bound of a fit of the free run on a grid that holds the truth, where the noise is an autoregression.
    fn free_run_bound(
        &self,
        of: RequestedFaults<'_>,
        (response, on): (&Response, &GridOnDrive),
        at: Place,
    ) -> Option<Vec<f64>> {
        let filter = NoiseFilter::of(of.case);
        let regression = &on.regressions.all()[0];
        let holds = of.case.order == of.case.system.order()
            && filter.ma.is_empty()
            && drive::lies_on(&of.border.hysteresis, &on.grid, of.v);
        if !holds {
            return None;
        }
        let (lags, input) = (&response.lags[at.checkpoint], &self.input[0][at.checkpoint]);
        let moments = regression.moments(at.checkpoint, lags, input);
        let output =
            Output { y: &response.z, checkpoint: at.checkpoint, period: None, kind: FitKind::Simulation };
        regression.free_run_bound(output, &moments, &filter.ar, self.sigma * self.sigma).ok()
    }

    /// How the cell at a checkpoint is estimated.
    fn analysis(
        &self,
        of: RequestedFaults<'_>,
        (response, on): (&Response, &GridOnDrive),
        at: Place,
    ) -> Result<Analysis, StudyError> {
        let limit = |number: usize, regression: &Regression| {
            let expected = self.expected(of.case, (number, regression), response, at);
            Limit::of(regression, &expected, self.sigma * self.sigma)
        };
        let Regressions::Nested(nested) = &on.regressions else {
            let limit = limit(0, &on.regressions.all()[0]).map_err(|source| {
                let (case, border) = (of.case.name.clone(), of.border.name.clone());
                StudyError::NotFromDrive { case, border, points: on.points, source }
            })?;
            return Ok(Analysis::Given(Box::new(limit)));
        };
        if of.case.knots == Knots::Refined {
            return Ok(Analysis::Refined);
        }
        let mut finest = 0;
        for (number, regression) in nested.on_grids() {
            let Ok(limit) = limit(number, regression) else { break };
            finest = number;
            let truth = truth(of.case, of.border, regression.grid());
            let errors = limit.theory_se();
            let biases = limit.parameters().iter().zip(&truth).zip(&errors);
            let squares: Vec<f64> = biases.map(|((x, t), se)| ((x - t) / se).powi(2)).collect();
            let (coefficients, points) = squares.split_at(2 * of.case.order);
            let mean = |squares: &[f64]| squares.iter().sum::<f64>() / squares.len() as f64;
            if mean(coefficients).max(mean(points)).sqrt() <= HOLDS {
                break;
            }
        }
        Ok(Analysis::Known(finest))
    }

    /// The moments of `y = z + σe` at a checkpoint, for the regression of a number.
    pub(super) fn moments(
        &self,
        (number, regression): (usize, &Regression),
        response: &Response,
        checkpoint: usize,
        noise: NoiseSums<'_>,
    ) -> Moments {
        let mixed = (noise.cross + noise.cross.transpose()) * self.sigma;
        let lags = &response.lags[checkpoint] + mixed + noise.lags * (self.sigma * self.sigma);
        let input = &self.input[number][checkpoint] + noise.input * self.sigma;
        regression.moments(checkpoint, &lags, &input)
    }

    /// Their mean over all noise: the noise-free output's, and the noise's stationary autocovariances.
    fn expected(
        &self,
        case: &Case,
        (number, regression): (usize, &Regression),
        response: &Response,
        at: Place,
    ) -> Moments {
        let filter = NoiseFilter::of(case);
        let gamma = autocovariance(&filter.ar, &filter.ma, case.order);
        let width = case.order + 1;
        let lags = DMatrix::from_fn(width, width, |i, l| at.samples as f64 * gamma[i.abs_diff(l)]);
        let input = &self.input[number][at.checkpoint];
        let (no_cross, no_input) = (DMatrix::zeros(width, width), input * 0.0);
        let noise = NoiseSums { lags: &lags, cross: &no_cross, input: &no_input };
        self.moments((number, regression), response, at.checkpoint, noise)
    }
}

/// A checkpoint: its number and its samples.
#[derive(Debug, Clone, Copy)]
struct Place {
    checkpoint: usize,
    samples: usize,
}

/// A grid holds the truth if the bias that it leaves is no larger than this share of the standard error.
const HOLDS: f64 = 1.0 / 3.0;

/// Whether the regression's equation error is white and its order right.
fn keeps_assumptions(case: &Case) -> bool {
    matches!(case.disturbance, Disturbance::White) && case.order == case.system.order()
}

fn names(order: usize, grid: &Grid) -> Vec<ParameterName> {
    let borders = [(Group::Descending, grid.basis.descending()), (Group::Ascending, grid.basis.ascending())];
    ParameterName::all(order, &borders)
}

/// The true parameters in the normalisation `u_M − u_m = 1`, as far as a regression of the assumed order names them.
fn truth(case: &Case, border: &Border, grid: &Grid) -> Vec<f64> {
    use switchback_model::hysteresis::Branch::{Ascending, Descending};
    let hysteresis = &border.hysteresis;
    let named = |c: &[f64]| (0..case.order).map(|i| c.get(i).copied().unwrap_or(0.0)).collect::<Vec<_>>();
    let mut truth = [named(case.system.a()), named(case.system.normalised(hysteresis.span()).b())].concat();
    for (branch, knots) in [(Descending, grid.basis.descending()), (Ascending, grid.basis.ascending())] {
        truth.extend(knots.iter().map(|&v| hysteresis.border(branch, v) / hysteresis.span()));
    }
    truth
}
