//! What the estimate on a grid tends to, and how it gets there.

use super::equation_error::Moments;
use super::error::FreeError;
use super::fit::equation_error_fit;
use super::normalise::{Covariance, quantities};
use super::rank_one::{information, score};
use super::regression::Regression;
use super::units::OutputUnits;
use nalgebra::DVector;

/// The estimate from expected moments, with its first-order response to any others.
///
/// Let `M = E[S]` be the moments expected of an input at some `N`, `θ*` what least squares and rank one make of them, `J` the derivative of
/// the regression's coefficients in `θ`, and `s = J'(S_Φy − S_ΦΦ·products(θ*))` the score. Then
///
/// ```text
/// θ̂ − θ* = (J'MJ)⁻¹ s + smaller terms,     E[s] = 0 exactly
/// ```
///
/// which makes the first-order part a control variate, and where the model holds and the equation error is white with variance `σ²`,
/// `σ²(J'MJ)⁻¹` is the asymptotic covariance and the Cramér–Rao bound at once.
#[derive(Debug, Clone)]
pub struct Limit {
    theta: super::problem::Parameters,
    covariance: Covariance,
    values: Vec<f64>,
    derivatives: Vec<DVector<f64>>,
}

impl Limit {
    /// The limit for the moments expected of a regression; `noise_variance` is that of the equation error.
    ///
    /// # Errors
    /// [`FreeError::NotExcited`] if the input leaves a parameter open.
    pub fn of(regression: &Regression, expected: &Moments, noise_variance: f64) -> Result<Self, FreeError> {
        let theta = equation_error_fit(expected).ok_or(FreeError::NotExcited)?;
        let covariance = Covariance::new(&information(expected, &theta), &theta, noise_variance)
            .ok_or(FreeError::NotExcited)?;
        let quantities = quantities(&theta, &regression.grid().basis, OutputUnits::OWN);
        let (values, derivatives) = quantities.into_iter().map(|q| (q.value, q.derivative)).unzip();
        Ok(Self { theta, covariance, values, derivatives })
    }

    /// The parameters `a`, `b`, descending border, ascending border, in the normalisation `u_M − u_m = 1`.
    pub fn parameters(&self) -> &[f64] {
        &self.values
    }

    /// Their asymptotic standard deviations.
    pub fn theory_se(&self) -> Vec<f64> {
        self.derivatives.iter().map(|d| self.covariance.standard_error(d)).collect()
    }

    /// First-order part of each parameter's error for the moments of one record.
    pub fn first_order(&self, moments: &Moments) -> Vec<f64> {
        let response = self.covariance.response(&score(moments, &self.theta));
        self.derivatives.iter().map(|d| d.dot(&response)).collect()
    }
}
