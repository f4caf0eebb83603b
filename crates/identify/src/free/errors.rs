//! What a fit knows of its own errors.

use super::basis::Basis;
use super::equation_error::Moments;
use super::normalise::{Covariance, Figures, normalise};
use super::problem::Parameters;
use super::rank_one::{information, residual_energy};
use super::runs::Runs;
use super::units::OutputUnits;
use crate::Estimate;
use nalgebra::DMatrix;

/// What a fit knows of its own errors.
#[derive(Debug)]
pub(super) struct Errors {
    /// Of the noise, squared output units.
    pub(super) variance: f64,
    /// Per unit noise variance.
    pub(super) information: DMatrix<f64>,
    /// None if a parameter has no information.
    pub(super) covariance: Option<Covariance>,
}

impl Errors {
    /// Of a fit of least simulation error, filtered by `D` of the given coefficients; the variance is that of the filtered error.
    pub(super) fn of_simulation(
        moments: &Moments,
        theta: &Parameters,
        runs: &Runs,
        whitening: &[f64],
    ) -> Self {
        let (information, energy, batches) = runs.scatter(moments.structure, theta, whitening);
        let variance = energy / freedom(moments, theta);
        let covariance = Covariance::new(&information, theta, variance).map(|c| c.with_batches(&batches));
        Self { variance, information, covariance }
    }

    /// Of a fit of least equation error.
    pub(super) fn of_equation(moments: &Moments, theta: &Parameters) -> Self {
        let variance = residual_energy(moments, theta) / freedom(moments, theta);
        let information = information(moments, theta);
        let covariance = Covariance::new(&information, theta, variance);
        Self { variance, information, covariance }
    }
}

/// Normalised parameters of an equation-error fit and their standard errors.
pub(super) fn equation_error_estimate(moments: &Moments, basis: &Basis, theta: &Parameters) -> Estimate {
    let errors = Errors::of_equation(moments, theta);
    let figures = figures(moments, errors.variance, OutputUnits::OWN);
    normalise(theta, moments.structure, basis, errors.covariance.as_ref(), figures)
}

/// Samples less free parameters, at least 1; one parameter in `b` and `f` is the scale that they share.
fn freedom(moments: &Moments, theta: &Parameters) -> f64 {
    let parameters = theta.a.len() + theta.b.len() + theta.f.len();
    moments.samples.saturating_sub(parameters).max(1) as f64
}

pub(super) fn figures(moments: &Moments, variance: f64, units: OutputUnits) -> Figures {
    let (excitation, samples) = (smallest_eigenvalue(moments), moments.samples);
    Figures { noise_sd: variance.sqrt(), excitation, samples, units }
}

/// λ_min of the over-parameterised regression's information matrix, per sample.
fn smallest_eigenvalue(moments: &Moments) -> f64 {
    let p = moments.constant() + 1;
    let information: DMatrix<f64> = moments.matrix.view((0, 0), (p, p)) / moments.samples as f64;
    information.symmetric_eigenvalues().min().max(0.0)
}
