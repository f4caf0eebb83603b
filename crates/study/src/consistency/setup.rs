//! One system, hysteresis and number of points in the setup: everything about its experiments that noise does not touch.

use super::error::StudyError;
use super::pulse_kind::PulseKind;
use crate::scenario::{Border, Case, Disturbance};
use switchback_identify::excitation::{Direction, PulseExperiment};
use switchback_identify::pulse::lanes::{LaneMethod, LaneStatistics};
use switchback_identify::pulse::{
    Cumulants, EquationNoise, ErrorTerms, ExpectedRecord, FiniteSampleTheory, GroupSum, Limit, PulseData,
    PulseFitError, PulseMethod, StepMean,
};
use switchback_identify::simulation::{
    Grouping, LaneSuperposition, NoiseMoments, PeriodicDesign, SumCovariance, periodic_response, superpose,
};
use switchback_model::hysteresis::Branch;
use switchback_model::linear::{NoiseMemory, settling_samples};

/// Descendant and ascendant experiment, in this order wherever there are two of anything.
pub(super) const DIRECTIONS: [Direction; 2] = [Direction::Descendant, Direction::Ascendant];

/// Both experiments on one hysteresis, unrolled.
#[derive(Debug, Clone)]
pub(super) struct Setup {
    pub(super) points: usize,
    experiments: [PulseExperiment; 2],
    designs: [PeriodicDesign; 2],
    responses: [Vec<f64>; 2],
    /// Noise-free outputs at the satellites.
    satellites: [f64; 2],
    truth: Truth,
    noise: NoiseFilter,
    /// Whether the equation error is white.
    is_white: bool,
}

/// The true parameters in the normalisation `u_M − u_m = 1`, as far as a regression of the assumed order names them.
#[derive(Debug, Clone)]
struct Truth {
    a: Vec<f64>,
    b: Vec<f64>,
    borders: [Vec<f64>; 2],
}

/// The noise `e = C/A w` that is added to the noise-free response.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct NoiseFilter {
    pub(super) ar: Vec<f64>,
    pub(super) ma: Vec<f64>,
}

impl NoiseFilter {
    /// What a disturbance of the system `A` amounts to in the output.
    pub(super) fn of(case: &Case) -> Self {
        let a = case.system.a();
        match &case.disturbance {
            Disturbance::White => Self { ar: a.to_vec(), ma: Vec::new() },
            Disturbance::Coloured { ar, ma } => Self { ar: product(a, ar), ma: ma.clone() },
            Disturbance::Output => Self { ar: Vec::new(), ma: Vec::new() },
        }
    }

    /// Samples to run before a record begins, so that the noise in it is stationary.
    pub(super) fn burn_in(&self) -> usize {
        settling_samples(&self.ar, STATIONARY) + self.ma.len()
    }
}

/// What is left of the impulse response when a record of noise begins.
const STATIONARY: f64 = 1e-16;

/// Coefficients `1…` of the product of two monic polynomials.
fn product(p: &[f64], q: &[f64]) -> Vec<f64> {
    let coefficient = |c: &[f64], k: usize| if k == 0 { 1.0 } else { c.get(k - 1).copied().unwrap_or(0.0) };
    (1..=p.len() + q.len())
        .map(|k| (0..=k).map(|i| coefficient(p, i) * coefficient(q, k - i)).sum())
        .collect()
}

impl Setup {
    pub(super) fn new(case: &Case, border: &Border, points: usize) -> Result<Self, StudyError> {
        let hysteresis = &border.hysteresis;
        let experiment = |direction| {
            PulseExperiment::evenly_spaced(hysteresis.interval(), direction, points, case.order)
                .and_then(|e| e.with_spacing_unmasked(case.spacing))
                .map_err(|error| StudyError::NoExperiment {
                    case: case.name.clone(),
                    points,
                    reason: error.to_string(),
                })
        };
        let [descendant, ascendant] = DIRECTIONS.map(experiment);
        let experiments = [descendant?, ascendant?];
        let designs = [0, 1].map(|k| PeriodicDesign::new(&experiments[k], hysteresis, case.order));
        let responses = [0, 1].map(|k| periodic_response(&case.system, &designs[k].u));
        let gain = case.system.static_gain();
        let named = |c: &[f64]| (0..case.order).map(|i| c.get(i).copied().unwrap_or(0.0)).collect::<Vec<_>>();
        let truth = Truth {
            a: named(case.system.a()),
            b: named(case.system.normalised(hysteresis.span()).b()),
            borders: [0, 1].map(|k| {
                let design: &PeriodicDesign = &designs[k];
                design
                    .levels
                    .iter()
                    .map(|v| hysteresis.border(design.branch, *v) / hysteresis.span())
                    .collect()
            }),
        };
        Ok(Self {
            points,
            responses,
            satellites: [gain * hysteresis.u_high(), gain * hysteresis.u_low()],
            truth,
            is_white: matches!(case.disturbance, Disturbance::White),
            noise: NoiseFilter::of(case),
            experiments,
            designs,
        })
    }

    pub(super) fn period(&self) -> usize {
        self.designs[0].period()
    }

    /// `V₁…V_m` of an experiment.
    pub(super) fn levels(&self, experiment: usize) -> &[f64] {
        &self.designs[experiment].levels
    }

    /// Where the input of an experiment rests.
    pub(super) fn satellite(&self, experiment: usize) -> f64 {
        self.designs[experiment].satellite
    }

    /// The noise-free output there.
    pub(super) fn satellite_output(&self, experiment: usize) -> f64 {
        self.satellites[experiment]
    }

    /// The border that an experiment reveals.
    pub(super) fn branch(&self, experiment: usize) -> Branch {
        self.designs[experiment].branch
    }

    /// The input of an experiment: one sample that loads the border, then `samples` from phase 0 on.
    pub(super) fn input(&self, experiment: usize, samples: usize) -> Vec<f64> {
        self.experiments[experiment].record_input(samples)
    }

    /// Samples before `t = 0` of the records that others estimate from: the lags of the first, and the move before them.
    pub(super) fn lead(&self) -> usize {
        self.designs[0].order + 1
    }

    /// The input of an experiment that repeats, from [`lead`](Self::lead) samples before `t = 0` on.
    pub(super) fn periodic_input(&self, experiment: usize, samples: usize) -> Vec<f64> {
        let before = self.lead().next_multiple_of(self.period());
        let v = self.input(experiment, before + samples);
        v[1 + before - self.lead()..].to_vec()
    }

    /// The noise-free output of an experiment, over one period.
    pub(super) fn response(&self, experiment: usize) -> &[f64] {
        &self.responses[experiment]
    }

    /// Whether the paper's assumptions hold but for the colour of the noise: the right order, masked memory.
    pub(super) fn has_the_model(&self, case: &Case) -> bool {
        case.order == case.system.order()
            && case.spacing >= case.order
            && (case.spacing >= 2 || self.points <= 2)
    }

    /// The statistics of both experiments with the noise of one replicate.
    pub(super) fn data(&self, sigma: f64, noise: [&NoiseMoments; 2]) -> [PulseData; 2] {
        [0, 1].map(|k| superpose(&self.designs[k], &self.responses[k], sigma, noise[k]))
    }

    /// The mean outputs of the step experiments, given the mean of the unit noise in each.
    pub(super) fn steps(&self, sigma: f64, noise_means: [f64; 2], samples: f64) -> [StepMean; 2] {
        [0, 1].map(|k| StepMean { mean: self.satellites[k] + sigma * noise_means[k], samples })
    }

    /// The true values of a method's parameters, in its order.
    pub(super) fn truth(&self, method: PulseKind) -> Vec<f64> {
        let mut truth = [self.truth.a.as_slice(), self.truth.b.as_slice()].concat();
        for &k in method.experiments() {
            truth.extend(&self.truth.borders[k]);
        }
        truth
    }

    /// What a method makes of the expected statistics of records of `samples` samples.
    pub(super) fn limit(
        &self,
        method: PulseKind,
        sigma: f64,
        samples: usize,
    ) -> Result<Limit, PulseFitError> {
        let data = self.expected(sigma, samples);
        method.with_input(&data, self.steps(sigma, [0.0; 2], samples as f64), Limit::of)
    }

    /// What a method's estimate from records of `samples` samples will be off, `limit` being that of such records; and the cumulants of its
    /// first-order part.
    pub(super) fn theory(
        &self,
        method: PulseKind,
        limit: &Limit,
        (sigma, memory): (f64, &NoiseMemory),
        samples: usize,
    ) -> (FiniteSampleTheory, Vec<Cumulants>) {
        let record = |&k: &usize| ExpectedRecord {
            groups: &self.designs[k].groups,
            response: &self.responses[k],
            samples,
        };
        let records: Vec<ExpectedRecord<'_>> = method.experiments().iter().map(record).collect();
        let noise = EquationNoise { sigma, memory };
        let theory = limit.finite_sample(&records, noise);
        let theory = match limit.fold_sd(self.fold_covariance(sigma, samples)) {
            Some(sd) => FiniteSampleTheory { sd, ..theory },
            None => theory,
        };
        (theory, limit.cumulants(&records, noise))
    }

    /// The exact means of the error terms at a method's limit, for records of `samples` samples.
    pub(super) fn mean_terms(
        &self,
        method: PulseKind,
        limit: &Limit,
        sigma: f64,
        samples: usize,
    ) -> ErrorTerms {
        let NoiseFilter { ar, ma } = &self.noise;
        let data = self.expected(sigma, samples);
        let designs: Vec<&PeriodicDesign> = method.experiments().iter().map(|&k| &self.designs[k]).collect();
        let covariance = SumCovariance::new(&designs, (ar, ma), sigma, samples);
        method.with_input(&data, self.steps(sigma, [0.0; 2], samples as f64), |expected| {
            limit.mean_terms(&expected, |x, y| covariance.at(x, y))
        })
    }

    /// A method for these experiments, eight replicates at a time.
    pub(super) fn lanes(&self, method: PulseKind) -> LaneMethod {
        let data = self.expected(1.0, self.period());
        method.with_input(&data, self.steps(1.0, [0.0; 2], 1.0), |method| LaneMethod::of(&method))
    }

    /// How both experiments sort `samples` samples into groups: it depends on the number of points alone.
    pub(super) fn grouping(&self, samples: usize) -> Grouping {
        Grouping::new(&self.designs[0], samples)
    }

    /// The statistics of both experiments over `samples` samples, as functions of noise and noise level.
    pub(super) fn superpositions(&self, samples: usize) -> [LaneSuperposition; 2] {
        [0, 1].map(|k| LaneSuperposition::new(&self.designs[k], &self.responses[k], samples))
    }

    /// One replicate's data by itself.
    pub(super) fn replicate(&self, statistics: &[LaneStatistics; 2], lane: usize) -> [PulseData; 2] {
        [0, 1].map(|k| {
            let PeriodicDesign { branch, levels, satellite, .. } = &self.designs[k];
            let alone = statistics[k].replicate(lane);
            let data = PulseData::from_statistics(*branch, levels.clone(), *satellite, alone);
            data.with_folds(statistics[k].folds(lane))
        })
    }

    /// The Cramér–Rao bound, as standard deviations, for the data a method uses: the theory of the efficient estimate on them.
    ///
    /// The paper's methods use a step experiment of as many samples besides; they join those that see the satellite.
    pub(super) fn bound(
        &self,
        method: PulseKind,
        sigma: f64,
        samples: usize,
    ) -> Result<Vec<f64>, PulseFitError> {
        if method.folds() && !self.is_white {
            return self.bound_of_colour(sigma, samples);
        }
        let data = self.expected(sigma, samples);
        let limit = match method.experiments() {
            &[k] => {
                let statistics = data[k].statistics.merged(&self.expected_step(k, sigma, samples).statistics);
                let PulseData { branch, satellite, ref levels, .. } = data[k];
                let with_step = PulseData::from_statistics(branch, levels.clone(), satellite, statistics);
                Limit::of(PulseMethod::Efficient(&[&with_step]))?
            }
            _ => Limit::of(PulseMethod::Efficient(&[&data[0], &data[1]]))?,
        };
        Ok(limit.first_order_sd(sigma, 0.0))
    }

    /// The bound of the folds, as standard deviations, where the colour of the noise has nothing to do with the parameters.
    fn bound_of_colour(&self, sigma: f64, samples: usize) -> Result<Vec<f64>, PulseFitError> {
        let [descendant, ascendant] = self.expected(sigma, samples);
        let law = (self.noise.ar.as_slice(), self.noise.ma.as_slice());
        let limit = Limit::of_known_colour(&[&descendant, &ascendant], law, sigma)?;
        Ok(limit.theory_se(samples as f64))
    }

    /// The covariance of two means over the periods of `samples` samples, by their phases.
    pub(super) fn fold_covariance(&self, sigma: f64, samples: usize) -> impl Fn(usize, usize) -> f64 {
        let NoiseFilter { ar, ma } = &self.noise;
        let sums = SumCovariance::of_single_phases(self.period(), (ar, ma), sigma, samples);
        let period = self.period();
        let count = move |p: usize| ((samples + period - 1 - p) / period) as f64;
        let sum = |phase| GroupSum { group: phase, lag: 0 };
        move |p, q| sums.at(sum(p), sum(q)) / (count(p) * count(q))
    }

    /// The mean of both experiments' statistics over records of `samples` samples.
    fn expected(&self, sigma: f64, samples: usize) -> [PulseData; 2] {
        let NoiseFilter { ar, ma } = &self.noise;
        let noise = NoiseMoments::expected_over(ar, ma, self.designs[0].order, self.period(), samples);
        self.data(sigma, [&noise, &noise])
    }

    /// The step experiment at the satellite of experiment `k` as one more pulse experiment without pulses.
    fn expected_step(&self, k: usize, sigma: f64, samples: usize) -> PulseData {
        let design = PeriodicDesign { u: vec![0.0], groups: vec![0], ..self.designs[k].clone() };
        let NoiseFilter { ar, ma } = &self.noise;
        let noise = NoiseMoments::expected_over(ar, ma, design.order, 1, samples);
        superpose(&design, &[self.satellites[k]], sigma, &noise)
    }
}
