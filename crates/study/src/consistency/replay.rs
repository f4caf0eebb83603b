//! One replicate again: its estimates in every cell, and the records they are made from, sample by sample.

use super::cell_design::{CellDesign, MethodCase};
use super::direct::{OpenNoise, OpenRecord};
use super::error::StudyError;
use super::noise::{ReplicateNoise, draw};
use super::noise_group::{self, NoiseGroup};
use super::setup::DIRECTIONS;
use crate::results::Series;
use crate::scenario::Scenario;
use switchback_identify::excitation::Direction;
use switchback_identify::pulse::{PulseData, PulseFitError, StepMean};

/// What one replicate gave in one cell.
#[derive(Debug, Clone, PartialEq)]
pub struct ReplayedCell {
    /// The curve the cell is a point of.
    pub series: Series,
    /// `N`.
    pub samples: usize,
    /// `a`, `b`, then the border points, in the order of the results.
    pub estimates: Result<Vec<f64>, PulseFitError>,
}

/// The experiments of one replicate on one border with `m` points at one noise level, in the open.
#[derive(Debug, Clone, PartialEq)]
pub struct ReplayedRecords {
    /// Name of the case.
    pub case: String,
    /// Name of the border.
    pub border: String,
    /// Points `m`.
    pub points: usize,
    /// Standard deviation of the noise, output units.
    pub noise: f64,
    /// `u_M − u_m`: estimates of `b` are in output units a span, those of the borders in spans.
    pub span: f64,
    /// Descendant and ascendant experiment.
    pub experiments: [ReplayedExperiment; 2],
}

/// One pulse experiment in the open.
#[derive(Debug, Clone, PartialEq)]
pub struct ReplayedExperiment {
    /// Which one.
    pub direction: Direction,
    /// `V₁…V_m`.
    pub levels: Vec<f64>,
    /// Where the input rests.
    pub satellite: f64,
    /// Samples before `t = 0`, which serve as lags only.
    pub lead: usize,
    /// `v(t)`, `t = −lead…N−1`, `N` the largest of the sweep.
    pub v: Vec<f64>,
    /// `y(t)` of the same `t`.
    pub y: Vec<f64>,
    /// Mean output of the step experiment at the satellite, one a number of samples of the sweep.
    pub step_means: Vec<f64>,
}

/// The estimates of one replicate in every cell of the pulse methods, in the order of the results, by the estimators as a user calls them: what
/// the study's own arithmetic, eight replicates at a time, is held against.
///
/// # Errors
/// [`StudyError`] if a method or an experiment does not exist for some cell.
pub fn replay(scenario: &Scenario, replicate: u32) -> Result<Vec<ReplayedCell>, StudyError> {
    let groups = noise_group::plan(scenario)?;
    let mut cells = Vec::new();
    for group in &groups {
        let noise = draw(&group.noise, scenario.seed(), replicate..replicate + 1);
        for cell_design in &group.cell_designs {
            for (checkpoint, &samples) in group.noise.pulses.checkpoints.iter().enumerate() {
                let sample = Sample::new(group, cell_design, checkpoint, &noise[0]);
                cells.extend(cell_design.methods.iter().map(|method_case| ReplayedCell {
                    series: cell_design.series(scenario, method_case.method),
                    samples,
                    estimates: sample.estimates(method_case),
                }));
            }
        }
    }
    Ok(cells)
}

/// The data of one replicate in one setting, at one number of samples.
struct Sample {
    data: [PulseData; 2],
    steps: [StepMean; 2],
}

impl Sample {
    fn new(group: &NoiseGroup, cell_design: &CellDesign, checkpoint: usize, noise: &ReplicateNoise) -> Self {
        let samples = group.noise.pulses.checkpoints[checkpoint] as f64;
        Self {
            data: cell_design.setup.data(cell_design.sigma, noise.pulses(checkpoint, cell_design.period)),
            steps: cell_design.setup.steps(cell_design.sigma, noise.step_means(checkpoint), samples),
        }
    }

    /// The values of a method's parameters.
    fn estimates(&self, method_case: &MethodCase) -> Result<Vec<f64>, PulseFitError> {
        let fit = method_case.kind.with_input(&self.data, self.steps, |method| method.fit())?;
        Ok(fit.parameters().map(|p| p.value).collect())
    }
}

/// The records behind [`replay`], simulated sample by sample from a settled system on: what the direct engine fits.
///
/// # Errors
/// [`StudyError`] if a method or an experiment does not exist for some cell.
pub fn records(scenario: &Scenario, replicate: u32) -> Result<Vec<ReplayedRecords>, StudyError> {
    let groups = noise_group::plan(scenario)?;
    let of_group = |group: &NoiseGroup| {
        let noise = OpenNoise::draw(group, scenario.seed(), replicate);
        group.cell_designs.iter().map(|s| open(scenario, group, s, &noise)).collect::<Vec<_>>()
    };
    Ok(groups.iter().flat_map(of_group).collect())
}

fn open(
    scenario: &Scenario,
    group: &NoiseGroup,
    cell_design: &CellDesign,
    noise: &OpenNoise,
) -> ReplayedRecords {
    let case = &scenario.cases()[cell_design.case];
    let border = &case.borders[cell_design.border];
    let experiment = |k: usize| {
        let OpenRecord { lead, v, y, step_means } =
            noise.record(group, (case, border), (cell_design, cell_design.sigma), k);
        ReplayedExperiment {
            direction: DIRECTIONS[k],
            levels: cell_design.setup.levels(k).to_vec(),
            satellite: cell_design.setup.satellite(k),
            lead,
            v,
            y,
            step_means,
        }
    };
    ReplayedRecords {
        case: case.name.clone(),
        border: border.name.clone(),
        points: cell_design.setup.points,
        noise: cell_design.sigma,
        span: border.hysteresis.span(),
        experiments: [0, 1].map(experiment),
    }
}
