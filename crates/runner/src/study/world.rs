//! Worlds: cells that share their noise.

use super::StudyError;
use super::bench::{Bench, Bound, NoiseFilter, PulseKind};
use crate::results::Group;
use crate::scenario::{Case, Coupling, Disturbance, Method, Scenario};
use switchback_estimator::estimators::pulse::lanes::{LaneControl, LaneMethod};
use switchback_estimator::estimators::pulse::{Limit, PulseFitError};
use switchback_estimator::linear::settling_samples;
use switchback_estimator::simulation::noise::NoisePlan;

/// Streams of a world: descendant, ascendant, and the two step experiments.
pub(super) const STREAMS: u32 = 4;

/// What is left of the impulse response when a record of noise begins.
const STATIONARY: f64 = 1e-16;

/// Everything that one pass over the noise of one replicate serves.
#[derive(Debug, Clone)]
pub(super) struct World {
    /// First of its [`STREAMS`] noise streams.
    pub(super) stream: u32,
    /// What to record of the pulse experiments' noise.
    pub(super) pulses: NoisePlan,
    /// What to record of the step experiments' noise; `None` where no method asks for them.
    pub(super) steps: Option<NoisePlan>,
    /// Whether any method looks at the descendant, at the ascendant experiment.
    pub(super) experiments: [bool; 2],
    pub(super) settings: Vec<Setting>,
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
    /// The method, and the control variate, for eight replicates at a time.
    pub(super) lanes: LaneMethod,
    pub(super) control: LaneControl,
    /// Whether the model holds: the limit is then the truth, its theory the asymptotic one, and the bound applies.
    pub(super) theory: bool,
    pub(super) bound: Option<Bound>,
}

/// What a parameter is called, and with whom it is judged.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ParameterName {
    pub(super) name: String,
    pub(super) group: Group,
    pub(super) v: Option<f64>,
}

/// Lays out the worlds of a scenario.
///
/// With shared noise there is one world a case, and all of them use the same streams; with independent noise, one a bench, noise level
/// and number of samples, each with its own.
pub(super) fn plan(scenario: &Scenario) -> Result<Vec<World>, StudyError> {
    let samples = &scenario.sweep().samples;
    let mut worlds = Vec::new();
    for (index, case) in scenario.cases().iter().enumerate() {
        let settings = settings(scenario, index, case)?;
        match scenario.coupling() {
            Coupling::Shared => worlds.push(World::new(case, 0, samples, settings)),
            Coupling::Independent => {
                for setting in settings {
                    for n in samples {
                        let stream = STREAMS * worlds.len() as u32;
                        worlds.push(World::new(case, stream, &[*n], vec![setting.clone()]));
                    }
                }
            }
        }
    }
    Ok(worlds)
}

impl World {
    fn new(case: &Case, stream: u32, checkpoints: &[usize], mut settings: Vec<Setting>) -> Self {
        let mut periods: Vec<usize> = settings.iter().map(|s| s.bench.period()).collect();
        periods.sort_unstable();
        periods.dedup();
        for setting in &mut settings {
            setting.period = periods.iter().position(|p| *p == setting.bench.period()).unwrap_or_default();
        }
        let NoiseFilter { ar, ma } = NoiseFilter::of(case);
        let burn_in = settling_samples(&ar, STATIONARY) + ma.len();
        let needs_steps = settings.iter().flat_map(|s| &s.methods).any(|c| c.kind.needs_step());
        let steps = needs_steps.then(|| NoisePlan {
            ar: ar.clone(),
            ma: ma.clone(),
            lags: 0,
            periods: vec![1],
            checkpoints: checkpoints.to_vec(),
            burn_in,
        });
        let pulses =
            NoisePlan { ar, ma, lags: case.order, periods, checkpoints: checkpoints.to_vec(), burn_in };
        let kinds: Vec<PulseKind> = settings.iter().flat_map(|s| &s.methods).map(|c| c.kind).collect();
        let experiments = [0, 1].map(|k| kinds.iter().any(|kind| kind.experiments().contains(&k)));
        Self { stream, pulses, steps, experiments, settings }
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
}

fn settings(scenario: &Scenario, index: usize, case: &Case) -> Result<Vec<Setting>, StudyError> {
    let sweep = scenario.sweep();
    let mut settings = Vec::new();
    for (b, border) in case.borders.iter().enumerate() {
        for &points in &sweep.points {
            let bench = Bench::new(case, border, points)?;
            for &sigma in &sweep.noise {
                let methods = sweep
                    .methods
                    .iter()
                    .filter_map(|&method| Some((method, PulseKind::of(method)?)))
                    .map(|(method, kind)| {
                        Contender::new(case, &bench, sigma, method, kind).map_err(|source| {
                            StudyError::NoLimit {
                                method: method.name(),
                                case: case.name.clone(),
                                border: border.name.clone(),
                                points,
                                source,
                            }
                        })
                    })
                    .collect::<Result<_, _>>()?;
                settings.push(Setting {
                    case: index,
                    border: b,
                    bench: bench.clone(),
                    sigma,
                    period: 0,
                    methods,
                });
            }
        }
    }
    Ok(settings)
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
            theory,
            bound: if theory { Some(bench.bound(kind, sigma)?) } else { None },
        })
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
    let coefficients = |letter: char, group| {
        (1..=order).map(move |i| ParameterName { name: format!("{letter}{i}"), group, v: None })
    };
    let borders = kind.experiments().iter().flat_map(|&k| {
        let (label, group) = [("desc", Group::Descending), ("asc", Group::Ascending)][k];
        bench.levels(k).iter().enumerate().map(move |(j, &v)| ParameterName {
            name: format!("F_{label}(V{})", j + 1),
            group,
            v: Some(v),
        })
    });
    coefficients('a', Group::A).chain(coefficients('b', Group::B)).chain(borders).collect()
}
