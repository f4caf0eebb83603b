//! A regression with its solution.

use super::qr::{LeastSquares, Triangle};
use super::regression::Regression;
use nalgebra::DVector;
use switchback_identify::pulse::{PulseFitError, StepMean};

/// Step of a central difference, in units of the parameter's size.
const DIFFERENCE: f64 = 1e-6;

/// A regression with its solution.
pub(super) struct Solved<'a> {
    pub(super) regression: Regression<'a>,
    triangle: Triangle,
    least_squares: LeastSquares,
}

impl<'a> Solved<'a> {
    pub(super) fn of(regression: Regression<'a>) -> Result<Self, PulseFitError> {
        let triangle = regression.triangle();
        let least_squares = triangle.solve(0).ok_or(PulseFitError::NotExcited)?;
        Ok(Self { regression, triangle, least_squares })
    }

    pub(super) fn theta(&self) -> &[f64] {
        self.least_squares.solution.as_slice()
    }

    pub(super) fn b(&self) -> &[f64] {
        let n = self.regression.order;
        &self.theta()[n..2 * n]
    }

    /// Largest change of `b` and `w` since the step before.
    pub(super) fn moved_from(&self, before: &Self) -> f64 {
        let largest = |x: &[f64]| x.iter().fold(0.0, |m: f64, b| m.max(b.abs()));
        let changes: Vec<f64> = self.b().iter().zip(before.b()).map(|(new, old)| new - old).collect();
        let of_b = largest(&changes) / largest(self.b());
        let levels = |s: &Self| s.regression.levels(s.theta()).into_iter().flatten().collect::<Vec<f64>>();
        let pairs = levels(self).into_iter().zip(levels(before));
        pairs.map(|(new, old)| (new - old).abs() / new.abs().max(1.0)).fold(of_b, f64::max)
    }

    /// Delta method, its derivatives by central differences. The error `δ` of a step experiment's mean (variance `σ²/(A(1)²L)`) enters directly, and
    /// through the regression about it, whose residual it leaves at `−A(1)δ`.
    pub(super) fn estimates(&self, step: Option<StepMean>) -> Result<Vec<(f64, f64)>, PulseFitError> {
        let (theta, mean) = (self.theta(), step.map_or(0.0, |s| s.mean));
        let values = self.regression.read(theta, mean);
        let variance = self.least_squares.residual / self.least_squares.freedom;
        let a_at_one = 1.0 + theta[..self.regression.order].iter().sum::<f64>();
        let to_constant = self.triangle.solve(1).ok_or(PulseFitError::NotExcited)?.solution;
        let jacobian = self.jacobian(mean);
        let direct = slopes(|x| self.regression.read(theta, x), mean);
        let through_step = step.map_or(0.0, |s| variance / (a_at_one * a_at_one * s.samples));
        let mut estimates = Vec::with_capacity(values.len());
        for (k, value) in values.into_iter().enumerate() {
            let gradient = DVector::from_iterator(theta.len(), jacobian.iter().map(|column| column[k]));
            let own = self.triangle.quadratic(&gradient).ok_or(PulseFitError::NotExcited)?;
            let slope = direct[k] - a_at_one * gradient.dot(&to_constant);
            estimates.push((value, (variance * own + slope * slope * through_step).sqrt()));
        }
        Ok(estimates)
    }

    /// Derivatives of everything reported, one list a regression parameter.
    pub(super) fn jacobian(&self, mean: f64) -> Vec<Vec<f64>> {
        let at = |i: usize, x: f64| {
            let mut theta = self.theta().to_vec();
            theta[i] = x;
            self.regression.read(&theta, mean)
        };
        (0..self.theta().len()).map(|i| slopes(|x| at(i, x), self.theta()[i])).collect()
    }
}

/// Central differences of a list of functions of one variable.
pub(super) fn slopes(f: impl Fn(f64) -> Vec<f64>, x: f64) -> Vec<f64> {
    let h = DIFFERENCE * (x.abs() + 1e-2);
    let (above, below) = (f(x + h), f(x - h));
    above.iter().zip(&below).map(|(a, b)| (a - b) / (2.0 * h)).collect()
}
