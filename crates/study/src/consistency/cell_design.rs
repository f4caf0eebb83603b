//! Benches at a noise level, and the methods that are tried there.

use super::cell::ParameterName;
use super::error::StudyError;
use super::pulse_kind::PulseKind;
use super::sections::Outcome;
use super::setup::Setup;
use crate::results::{Group, Series};
use crate::scenario::{Case, Disturbance, Scenario};
use rayon::prelude::*;
use switchback_identify::Method;
use switchback_identify::pulse::lanes::{LaneControl, LaneMethod};
use switchback_identify::pulse::{Limit, PulseFitError, PulseMethod, SecondOrder};
use switchback_model::linear::NoiseMemory;

/// One setup at one noise level: the cells over N and methods.
#[derive(Debug, Clone)]
pub(super) struct CellDesign {
    pub(super) case: usize,
    pub(super) border: usize,
    pub(super) setup: Setup,
    pub(super) sigma: f64,
    /// Index of the setup's period in the plan.
    pub(super) period: usize,
    pub(super) methods: Vec<MethodCase>,
}

/// A method in a setting.
#[derive(Debug, Clone)]
pub(super) struct MethodCase {
    pub(super) method: Method,
    pub(super) kind: PulseKind,
    pub(super) parameters: Vec<ParameterName>,
    pub(super) truth: Vec<f64>,
    /// The method for eight replicates at a time.
    pub(super) lanes: LaneMethod,
    /// Whether the model holds: the limit is then the truth, and theory and bound apply.
    pub(super) theory: bool,
    /// One entry a number of samples of the noise group.
    pub(super) expansions: Vec<Expansion>,
}

/// A method expanded about its limit at one number of samples.
#[derive(Debug, Clone)]
pub(super) struct Expansion {
    pub(super) limit: Limit,
    /// The control variate, for eight replicates at a time.
    pub(super) control: LaneControl,
    /// Variances of the first-order terms, where the model holds.
    pub(super) variances: Option<Vec<f64>>,
}

impl Expansion {
    fn new(
        setup: &Setup,
        (kind, second): (PulseKind, SecondOrder),
        (sigma, memory): (f64, &NoiseMemory),
        samples: usize,
    ) -> Result<Self, PulseFitError> {
        let limit = setup.limit(kind, sigma, samples)?;
        let step = if kind.needs_step() { sigma * sigma * memory.mean_variance(samples) } else { 0.0 };
        let exact = || limit.fold_sd(setup.fold_covariance(sigma, samples));
        let sds = || exact().unwrap_or_else(|| limit.first_order_sd(sigma, step));
        let variances = || sds().iter().map(|sd| sd * sd).collect();
        let variances = (second == SecondOrder::Whole).then(variances);
        Ok(Self { control: limit.lanes(second), limit, variances })
    }
}

impl CellDesign {
    /// The curve over N of one of its methods.
    pub(super) fn series(&self, scenario: &Scenario, method: Method) -> Series {
        let case = &scenario.cases()[self.case];
        Series {
            case: case.name.clone(),
            border: case.borders[self.border].name.clone(),
            method: method.into(),
            points: self.setup.points,
            noise: self.sigma,
        }
    }

    /// Expands its methods about their limits at these numbers of samples.
    ///
    /// # Errors
    /// [`StudyError`] where a method has no limit.
    pub(super) fn expand(
        &mut self,
        case: &Case,
        (samples, memory): (&[usize], &NoiseMemory),
    ) -> Result<(), StudyError> {
        let Self { setup, sigma, border, methods, .. } = self;
        for method_case in methods {
            let of = (method_case.kind, method_case.second());
            let expansion = |&n: &usize| Expansion::new(setup, of, (*sigma, memory), n);
            let MethodCase { method, expansions, .. } = method_case;
            *expansions = samples.iter().map(expansion).collect::<Result<_, _>>().map_err(|source| {
                let (case_name, border) = (case.name.clone(), case.borders[*border].name.clone());
                StudyError::NoLimit {
                    method: method.name(),
                    case: case_name,
                    border,
                    points: setup.points,
                    source,
                }
            })?;
        }
        Ok(())
    }
}

/// The settings of a case: borders, numbers of points, noise levels; their methods are not expanded yet.
///
/// # Errors
/// [`StudyError`] where an experiment does not exist for some cell.
pub(super) fn all(scenario: &Scenario, index: usize, case: &Case) -> Result<Vec<CellDesign>, StudyError> {
    let sweep = scenario.sweep();
    let setups: Vec<(usize, usize)> =
        (0..case.borders.len()).flat_map(|b| sweep.points.iter().map(move |&points| (b, points))).collect();
    let of_setup = |&(b, points): &(usize, usize)| {
        let border = &case.borders[b];
        let setup = Setup::new(case, border, points)?;
        let kinds = sweep.methods.iter().filter_map(|&method| Some((method, PulseKind::of(method)?)));
        let methods: Vec<MethodCase> =
            kinds.map(|(method, kind)| MethodCase::new(case, &setup, method, kind)).collect();
        let cell_design = |&sigma: &f64| CellDesign {
            case: index,
            border: b,
            setup: setup.clone(),
            sigma,
            period: 0,
            methods: methods.clone(),
        };
        Ok(sweep.noise.iter().map(cell_design).collect::<Vec<_>>())
    };
    let cell_designs: Vec<Result<Vec<CellDesign>, StudyError>> = setups.par_iter().map(of_setup).collect();
    // The first error in the order of the scenario, whichever thread was first.
    Ok(cell_designs.into_iter().collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect())
}

impl MethodCase {
    /// A method, not expanded yet.
    fn new(case: &Case, setup: &Setup, method: Method, kind: PulseKind) -> Self {
        let white = matches!(case.disturbance, Disturbance::White);
        Self {
            method,
            kind,
            parameters: parameters(case.order, setup, kind),
            truth: setup.truth(kind),
            lanes: setup.lanes(kind),
            theory: kind.models_hysteresis() && (white || kind.folds()) && setup.has_the_model(case),
            expansions: Vec::new(),
        }
    }

    /// How much of the second order is the control variate: all of it where its mean is known.
    pub(super) fn second(&self) -> SecondOrder {
        if self.theory { SecondOrder::Whole } else { SecondOrder::Profile }
    }

    /// Whether antithetic partners are estimated, too: where the mean of what they cancel is known to be zero, as the model holds.
    pub(super) fn is_paired(&self) -> bool {
        self.theory
    }

    /// What one record gives.
    pub(super) fn outcome(
        &self,
        checkpoint: usize,
        sample: &PulseMethod<'_>,
    ) -> Result<Outcome, PulseFitError> {
        let fit = sample.fit()?;
        let estimates = fit.parameters().map(|x| (x.value, x.se));
        Ok(self.outcome_of(checkpoint, sample, estimates))
    }

    /// The same of estimates, each with its standard error, that were made from it elsewhere.
    pub(super) fn outcome_of(
        &self,
        checkpoint: usize,
        sample: &PulseMethod<'_>,
        estimates: impl Iterator<Item = (f64, f64)>,
    ) -> Outcome {
        let terms = self.expansions[checkpoint].limit.terms(sample, self.second());
        let errors = estimates.zip(&self.truth).map(|((value, se), truth)| (value - truth, se)).collect();
        Outcome { errors, terms }
    }
}

fn parameters(order: usize, setup: &Setup, kind: PulseKind) -> Vec<ParameterName> {
    let border = |&k: &usize| ([Group::Descending, Group::Ascending][k], setup.levels(k));
    ParameterName::all(order, &kind.experiments().iter().map(border).collect::<Vec<_>>())
}
