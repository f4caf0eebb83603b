//! Benches at a noise level, and the methods that are tried there.

use super::StudyError;
use super::bench::{Bench, Bound};
use super::cell::ParameterName;
use super::pulse_kind::PulseKind;
use crate::results::{Group, Series};
use crate::scenario::{Case, Disturbance, Method, Scenario};
use rayon::prelude::*;
use switchback_estimator::estimators::pulse::lanes::{LaneControl, LaneMethod};
use switchback_estimator::estimators::pulse::{ErrorTerms, Limit, PulseFitError, PulseMethod};

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
    /// Means of the error terms at the limit, one entry a number of samples of the noise group.
    pub(super) means: Vec<ErrorTerms>,
    /// The method, and the control variate, for eight replicates at a time.
    pub(super) lanes: LaneMethod,
    pub(super) control: LaneControl,
    /// Whether the model holds: the limit is then the truth, its theory the asymptotic one, and the bound applies.
    pub(super) theory: bool,
    pub(super) bound: Option<Bound>,
}

impl Setting {
    /// The curve over N of one of its methods.
    pub(super) fn series(&self, scenario: &Scenario, method: Method) -> Series {
        let case = &scenario.cases()[self.case];
        Series {
            case: case.name.clone(),
            border: case.borders[self.border].name.clone(),
            method,
            points: self.bench.points,
            noise: self.sigma,
        }
    }
}

/// The settings of a case: borders, numbers of points, noise levels.
///
/// # Errors
/// [`StudyError`] where a method or an experiment does not exist for some cell.
pub(super) fn all(scenario: &Scenario, index: usize, case: &Case) -> Result<Vec<Setting>, StudyError> {
    let sweep = scenario.sweep();
    let benches: Vec<(usize, usize)> =
        (0..case.borders.len()).flat_map(|b| sweep.points.iter().map(move |&points| (b, points))).collect();
    let of_bench = |&(b, points): &(usize, usize)| {
        let border = &case.borders[b];
        let bench = Bench::new(case, border, points)?;
        let contender = |method: Method, kind, sigma| {
            Contender::new(case, &bench, sigma, method, kind).map_err(|source| StudyError::NoLimit {
                method: method.name(),
                case: case.name.clone(),
                border: border.name.clone(),
                points,
                source,
            })
        };
        let setting = |&sigma: &f64| {
            let kinds = sweep.methods.iter().filter_map(|&method| Some((method, PulseKind::of(method)?)));
            let methods =
                kinds.map(|(method, kind)| contender(method, kind, sigma)).collect::<Result<_, _>>()?;
            Ok(Setting { case: index, border: b, bench: bench.clone(), sigma, period: 0, methods })
        };
        sweep.noise.iter().map(setting).collect::<Result<Vec<_>, StudyError>>()
    };
    let settings: Vec<Result<Vec<Setting>, StudyError>> = benches.par_iter().map(of_bench).collect();
    // The first error in the order of the scenario, whichever thread was first.
    Ok(settings.into_iter().collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect())
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
            means: Vec::new(),
            theory,
            bound: if theory { Some(bench.bound(kind, sigma)?) } else { None },
        })
    }

    /// The leading terms of one replicate's error, less their means.
    pub(super) fn terms(&self, checkpoint: usize, sample: &PulseMethod<'_>) -> ErrorTerms {
        self.limit.terms(sample).less(&self.means[checkpoint])
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
    let border = |&k: &usize| ([Group::Descending, Group::Ascending][k], bench.levels(k));
    ParameterName::all(order, &kind.experiments().iter().map(border).collect::<Vec<_>>())
}
