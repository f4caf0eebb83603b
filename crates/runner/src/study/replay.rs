//! One replicate again: its estimates in every cell, and the records they are made from, sample by sample.

use super::StudyError;
use super::bench::DIRECTIONS;
use super::moments::{ReplicateNoise, draw};
use super::world::{self, Contender, Setting, World};
use crate::results::Series;
use crate::scenario::Scenario;
use switchback_estimator::estimators::pulse::{PulseData, PulseFitError, StepMean};
use switchback_estimator::excitation::Direction;
use switchback_estimator::simulation::noise::{StreamId, samples};

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

/// The estimates of one replicate in every cell, in the order of the results: to look into a failure or an outlier.
///
/// # Errors
/// [`StudyError`] if a method or an experiment does not exist for some cell.
pub fn replay(scenario: &Scenario, replicate: u32) -> Result<Vec<ReplayedCell>, StudyError> {
    let worlds = world::plan(scenario)?;
    let mut cells = Vec::new();
    for world in &worlds {
        let noise = draw(world, scenario.seed(), replicate..replicate + 1);
        for setting in &world.settings {
            for (checkpoint, &samples) in world.pulses.checkpoints.iter().enumerate() {
                let sample = Sample::new(world, setting, checkpoint, &noise[0]);
                cells.extend(setting.methods.iter().map(|contender| ReplayedCell {
                    series: setting.series(scenario, contender.method),
                    samples,
                    estimates: sample.estimates(contender),
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
    fn new(world: &World, setting: &Setting, checkpoint: usize, noise: &ReplicateNoise) -> Self {
        let samples = world.pulses.checkpoints[checkpoint] as f64;
        Self {
            data: setting.bench.data(setting.sigma, noise.pulses(checkpoint, setting.period)),
            steps: setting.bench.steps(setting.sigma, noise.step_means(checkpoint), samples),
        }
    }

    /// The values of a method's parameters.
    fn estimates(&self, contender: &Contender) -> Result<Vec<f64>, PulseFitError> {
        let fit = contender.kind.with_input(&self.data, self.steps, |method| method.fit())?;
        Ok(fit.parameters().map(|p| p.value).collect())
    }
}

/// The records behind [`replay`], simulated one by one: the noise-free response of a settled system plus the noise of the replicate.
///
/// # Errors
/// [`StudyError`] if a method or an experiment does not exist for some cell.
pub fn records(scenario: &Scenario, replicate: u32) -> Result<Vec<ReplayedRecords>, StudyError> {
    let worlds = world::plan(scenario)?;
    let of_world = |world: &World| {
        let noise = OpenNoise::draw(world, scenario.seed(), replicate);
        world.settings.iter().map(|s| noise.records(scenario, s)).collect::<Vec<_>>()
    };
    Ok(worlds.iter().flat_map(of_world).collect())
}

/// The noise of one replicate of a world, sample by sample.
struct OpenNoise {
    /// Samples before `t = 0`.
    lead: usize,
    pulses: [Vec<f64>; 2],
    /// Means of the step noise, by experiment and number of samples: all that the step experiments are used for.
    steps: [Vec<f64>; 2],
}

impl OpenNoise {
    fn draw(world: &World, seed: u64, replicate: u32) -> Self {
        let plan = &world.pulses;
        let open = |k: usize| {
            let count = plan.checkpoints.last().copied().unwrap_or_default();
            let id = StreamId { seed, experiment: world.stream + k as u32, replicate };
            let noise = samples(plan, id, count).expect("a world's noise plan is valid");
            // Before the burn-in there was rest.
            let mut e = vec![0.0; plan.lags.saturating_sub(noise.burn_in)];
            e.extend(&noise.e[noise.burn_in.saturating_sub(plan.lags)..]);
            e
        };
        let means = draw(world, seed, replicate..replicate + 1);
        let steps = |k: usize| (0..plan.checkpoints.len()).map(|c| means[0].step_means(c)[k]).collect();
        Self { lead: plan.lags, pulses: [0, 1].map(open), steps: [0, 1].map(steps) }
    }

    fn records(&self, scenario: &Scenario, setting: &Setting) -> ReplayedRecords {
        let case = &scenario.cases()[setting.case];
        let border = &case.borders[setting.border];
        let experiment = |k: usize| {
            let mean = |e: &f64| setting.bench.satellite_output(k) + setting.sigma * e;
            let (v, response) = setting.bench.simulate(
                &case.system,
                &border.hysteresis,
                k,
                (self.lead, self.pulses[k].len()),
            );
            let y = response.iter().zip(&self.pulses[k]).map(|(z, e)| z + setting.sigma * e).collect();
            ReplayedExperiment {
                direction: DIRECTIONS[k],
                levels: setting.bench.levels(k).to_vec(),
                satellite: setting.bench.satellite(k),
                lead: self.lead,
                v,
                y,
                step_means: self.steps[k].iter().map(mean).collect(),
            }
        };
        ReplayedRecords {
            case: case.name.clone(),
            border: border.name.clone(),
            points: setting.bench.points,
            noise: setting.sigma,
            span: border.hysteresis.span(),
            experiments: [0, 1].map(experiment),
        }
    }
}
