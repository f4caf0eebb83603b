//! The entry: records in, a system with its uncertainty out.

use super::data::{Data, Featured};
use super::equation_error::Moments;
use super::error::FreeError;
use super::fit::{Effort, Ladder};
use super::model::Model;
use super::normalise::{Covariance, Figures, normalise};
use super::problem::{Parameters, Segment, Structure};
use super::rank_one::{information, residual_energy};
use super::selection::{Selection, select, with_best_timing};
use super::settings::Settings;
use super::simulation_error::{cost, linearise};
use super::warning::{Examination, Warning};
use crate::estimators::Estimate;
use crate::record::Record;
use nalgebra::DMatrix;

/// What was identified, how it was chosen, and what speaks against it.
#[derive(Debug, Clone, PartialEq)]
pub struct Identified {
    /// Coefficients and borders with their standard errors, in the paper's normalisation.
    pub estimate: Estimate,
    /// The same system as a simulator.
    pub model: Model,
    /// How order, delay and knots were chosen.
    pub selection: Selection,
    /// Weak points.
    pub warnings: Vec<Warning>,
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
    settings.check()?;
    let data = with_best_timing(Data::new(records, settings)?, settings);
    let selection = select(&data, settings)?;
    let structure = selection.structure;
    let ladder = Ladder::new(&data, settings.input_map, selection.knots);
    let featured = ladder.top();
    let segments = featured.segments(structure);
    check_length(featured, structure, &segments)?;
    let fitted = if settings.refine {
        ladder.climb_from_smaller(structure, Effort::FINAL)
    } else {
        ladder.one_shot(structure, &segments)
    };
    let theta = fitted.ok_or(FreeError::Unstable { order: structure.order })?.theta;
    let warnings = examine(&data, featured, structure, &theta, &segments);
    let estimate = estimate(featured, structure, &theta, &segments, settings.refine);
    let model = Model { basis: featured.basis.clone(), structure, parameters: theta, rule: data.rule };
    Ok(Identified { estimate, model, selection, warnings })
}

/// At least two samples a parameter.
fn check_length(featured: &Featured, structure: Structure, segments: &[Segment]) -> Result<(), FreeError> {
    let samples = segments.iter().map(Segment::len).sum();
    let parameters = structure.order + structure.numerator() + featured.basis.features();
    if samples < 2 * parameters {
        return Err(FreeError::TooShort { samples, parameters });
    }
    Ok(())
}

/// Normalised parameters and their standard errors.
fn estimate(
    featured: &Featured,
    structure: Structure,
    theta: &Parameters,
    segments: &[Segment],
    refined: bool,
) -> Estimate {
    let moments = Moments::of(structure, featured.basis.features(), segments);
    let samples = moments.samples;
    let parameters = theta.a.len() + theta.b.len() + theta.f.len();
    let freedom = (samples - parameters.min(samples - 1)) as f64;
    let (energy, covariance) = if refined {
        let energy = cost(structure, theta, segments);
        let model = linearise(structure, theta, segments);
        let covariance = Covariance::new(&model.information, theta, energy / freedom);
        (energy, covariance.map(|c| c.with_batches(&model.batches)))
    } else {
        let energy = residual_energy(&moments, theta);
        (energy, Covariance::new(&information(&moments, theta), theta, energy / freedom))
    };
    let figures =
        Figures { noise_sd: (energy / freedom).sqrt(), excitation: smallest_eigenvalue(&moments), samples };
    normalise(theta, structure, &featured.basis, covariance.as_ref(), figures)
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
    let mut visits = vec![0; featured.basis.features() + 1];
    for cell in segments.iter().flat_map(|s| &s.cells[s.from..s.to]) {
        visits[cell.main.knot] += 1;
        visits[cell.main.knot + 1] += 1;
    }
    let reversals = data.records.iter().map(|(_, b)| b.reversals()).sum();
    let (noise, threshold) = (data.noise, data.rule.threshold);
    Examination { basis: &featured.basis, structure, theta, noise, threshold, reversals, visits }.warnings()
}
