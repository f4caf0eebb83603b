//! The entry: records in, a system with its uncertainty out.

use super::basis::Basis;
use super::data::{Data, Featured};
use super::doubt::Doubt;
use super::equation_error::Moments;
use super::error::FreeError;
use super::examination::Examination;
use super::fit::{Effort, Ladder};
use super::model::Model;
use super::normalise::{Covariance, Figures, level_errors, normalise};
use super::problem::{Parameters, Segment, Structure};
use super::progress::Progress;
use super::rank_one::{information, residual_energy};
use super::selection::{Selection, select, with_best_rule};
use super::settings::Settings;
use super::simulation_error::{cost, linearise};
use super::warning::Warning;
use crate::estimators::{BorderDistance, Estimate, LevelErrors};
use crate::record::Record;
use nalgebra::DMatrix;

/// What was identified, how it was chosen, and what speaks against it.
#[derive(Debug, Clone, PartialEq)]
pub struct Identified {
    /// Coefficients and borders with their standard errors, in the paper's normalisation.
    pub estimate: Estimate,
    /// Standard errors of the gain and the stationary outputs; none if a parameter has no information.
    pub level_errors: Option<LevelErrors>,
    /// The same system as a simulator.
    pub model: Model,
    /// How order, delay and knots were chosen.
    pub selection: Selection,
    /// How far the two borders lie apart against their errors; none for a model of one curve.
    pub distance: Option<BorderDistance>,
    /// Weak points.
    pub warnings: Vec<Warning>,
    /// Covariance of the model's coefficients `(a, b, f, c)`, row by row; absent where the records leave one of them open.
    pub covariance: Option<Vec<Vec<f64>>>,
}

/// Identifies a Hammerstein system from any records.
///
/// 1. The branch at every sample is read off `v` ([`crate::estimators::free::Branches`]).
/// 2. Whether reversals take effect at samples or between them is decided by the fit of a middling structure. Order, delay and knots are chosen by cross-validation where the settings leave them open.
/// 3. Least squares with one coefficient for every product `bᵢf_k`, drawn to rank one.
/// 4. With `refine`, Levenberg–Marquardt on the error of the free run.
///
/// Standard errors: without `refine` the equation error is taken as white; with it, each is the larger of the one for
/// white output errors and the one that the scatter of the gradient over batches of 128 samples gives, which allows for residuals of
/// any colour. Both take the structure as given and the branches as known.
///
/// # Errors
/// [`FreeError`] if there is nothing to identify from, or too little for the settings.
pub fn identify(records: &[&Record], settings: &Settings) -> Result<Identified, FreeError> {
    identify_watched(records, settings, &())
}

/// [`identify`], which tells how far it has come; the result does not depend on who hears.
///
/// # Errors
/// As [`identify`].
pub fn identify_watched(
    records: &[&Record],
    settings: &Settings,
    progress: &dyn Progress,
) -> Result<Identified, FreeError> {
    settings.check()?;
    let data = with_best_rule(Data::new(records, settings)?, settings);
    let selection = select(&data, settings, progress)?;
    let structure = selection.structure;
    let ladder = Ladder::new(&data, settings.input_map, selection.knots);
    let featured = ladder.top();
    let segments = featured.segments(structure);
    featured.basis.check_length(structure, &segments)?;
    let fitted = if settings.refine {
        ladder.climb_from_smaller(structure, Effort::FINAL)
    } else {
        ladder.one_shot(structure, &segments)
    };
    let theta = fitted.ok_or(FreeError::Unstable { order: structure.order })?.theta;
    let moments = Moments::of(structure, featured.basis.features(), &segments);
    let errors = if settings.refine {
        Errors::of_simulation(&moments, &theta, &segments)
    } else {
        Errors::of_equation(&moments, &theta)
    };
    let basis = &featured.basis;
    let figures = figures(&moments, errors.variance);
    let estimate = normalise(&theta, structure, basis, errors.covariance.as_ref(), figures);
    let (information, covariance) = (&errors.information, errors.covariance.as_ref());
    let doubt = Doubt { structure, basis, theta: &theta, information, covariance };
    let hollow = estimate.hollow_coefficients();
    let hollow = hollow.map(|(coefficient, sum)| Warning::CarrierNotTold { coefficient, sum }).collect();
    let examined = examine(&data, featured, structure, &theta, &segments);
    let warnings = [doubt.warnings(), hollow, examined].concat();
    let distance = doubt.distance();
    let level_errors = covariance.map(|covariance| level_errors(&theta, covariance));
    let covariance =
        covariance.map(|c| c.matrix().row_iter().map(|row| row.iter().copied().collect()).collect());
    let model = Model { basis: basis.clone(), structure, parameters: theta, rule: data.rule };
    Ok(Identified { estimate, level_errors, model, selection, distance, warnings, covariance })
}

/// What a fit knows of its own errors.
struct Errors {
    /// Of the noise, squared output units.
    variance: f64,
    /// Per unit noise variance.
    information: DMatrix<f64>,
    /// None if a parameter has no information.
    covariance: Option<Covariance>,
}

impl Errors {
    /// Of a fit of least simulation error.
    fn of_simulation(moments: &Moments, theta: &Parameters, segments: &[Segment]) -> Self {
        let structure = moments.structure;
        let model = linearise(structure, theta, segments);
        let variance = cost(structure, theta, segments) / freedom(moments, theta);
        let covariance =
            Covariance::new(&model.information, theta, variance).map(|c| c.with_batches(&model.batches));
        Self { variance, information: model.information, covariance }
    }

    /// Of a fit of least equation error.
    fn of_equation(moments: &Moments, theta: &Parameters) -> Self {
        let variance = residual_energy(moments, theta) / freedom(moments, theta);
        let information = information(moments, theta);
        let covariance = Covariance::new(&information, theta, variance);
        Self { variance, information, covariance }
    }
}

/// Normalised parameters of an equation-error fit and their standard errors.
pub(super) fn equation_error_estimate(moments: &Moments, basis: &Basis, theta: &Parameters) -> Estimate {
    let errors = Errors::of_equation(moments, theta);
    let figures = figures(moments, errors.variance);
    normalise(theta, moments.structure, basis, errors.covariance.as_ref(), figures)
}

/// Samples less free parameters, at least 1; one parameter in `b` and `f` is the scale that they share.
fn freedom(moments: &Moments, theta: &Parameters) -> f64 {
    let parameters = theta.a.len() + theta.b.len() + theta.f.len();
    moments.samples.saturating_sub(parameters).max(1) as f64
}

fn figures(moments: &Moments, variance: f64) -> Figures {
    Figures { noise_sd: variance.sqrt(), excitation: smallest_eigenvalue(moments), samples: moments.samples }
}

/// λ_min of the over-parameterised regression's information matrix, per sample.
fn smallest_eigenvalue(moments: &Moments) -> f64 {
    let p = moments.constant() + 1;
    let information: DMatrix<f64> = moments.matrix.view((0, 0), (p, p)) / moments.samples as f64;
    information.symmetric_eigenvalues().min().max(0.0)
}

/// Collects the warnings.
fn examine(
    data: &Data,
    featured: &Featured,
    structure: Structure,
    theta: &Parameters,
    segments: &[Segment],
) -> Vec<Warning> {
    let visits = featured.basis.visits(segments);
    let reversals = data.records.iter().map(|(_, b)| b.reversals()).sum();
    let (noise, threshold, range) = (data.noise, data.rule.threshold, data.interval.width());
    Examination { basis: &featured.basis, structure, theta, noise, threshold, range, reversals, visits }
        .warnings()
}
