//! Estimates of least free-run error on grids that are known beforehand, for many outputs of one input.

use super::equation_error::Moments;
use super::error::FreeError;
use super::errors::{Errors, figures};
use super::fit::{FitKind, Fitted, quick_equation_error_fit, simulated};
use super::nested::NestedRegressions;
use super::normalise::{Covariance, normalise, quantities};
use super::problem::Segment;
use super::regression::Regression;
use super::runs::{Fold, Folded, Runs};
use super::undersmoothing::{GridFit, undersmoothed};
use super::units::OutputUnits;
use crate::Estimate;

/// An output of the input of a [`Regression`].
#[derive(Debug, Clone, Copy)]
pub struct Output<'a> {
    /// One value a sample of the input.
    pub y: &'a [f64],
    /// Number of the checkpoint that it is used up to.
    pub checkpoint: usize,
    /// The samples after which the input repeats itself, if it does and the response settles within one of its periods: the fit then costs the
    /// same for any length of the record.
    pub period: Option<usize>,
    /// What is made least: [`FitKind::Simulation`] or [`FitKind::Prewhitened`].
    pub kind: FitKind,
}

/// The output's samples that a regression explains, folded where that pays.
struct Explained<'a> {
    fold: Option<(Fold<'a>, Folded)>,
    y: &'a [f64],
    from: usize,
    to: usize,
}

impl<'a> Explained<'a> {
    fn of(output: Output<'a>, regression: &Regression) -> Self {
        let from = regression.start();
        let to = from + regression.checkpoints[output.checkpoint];
        let fold = output.period.and_then(|period| {
            let fold = Fold { y: output.y, from, to, period };
            Some((fold, fold.means()?))
        });
        Self { fold, y: output.y, from, to }
    }

    fn runs<'b>(&'b self, regression: &'b Regression) -> Runs<'b> {
        let (cells, from) = (&regression.cells, self.from);
        match &self.fold {
            Some((fold, folded)) => {
                let (y, weights, to) = (&folded.y[..], Some(&folded.weights[..]), from + 3 * fold.period);
                Runs {
                    segments: vec![Segment { y, cells, from, to, weights, counted_from: from }],
                    fold: Some(*fold),
                }
            }
            None => Runs::new(vec![Segment {
                y: self.y,
                cells,
                from,
                to: self.to,
                weights: None,
                counted_from: from,
            }]),
        }
    }
}

impl Regression {
    /// The estimate of least free-run error on the grid itself; `moments` are those of the output, where the search starts.
    ///
    /// # Errors
    /// [`FreeError::NotExcited`] if the samples leave a parameter open.
    pub fn free_run_estimate(&self, output: Output<'_>, moments: &Moments) -> Result<Estimate, FreeError> {
        let explained = Explained::of(output, self);
        let fitted = first_fit(self, &explained, output.kind, moments).ok_or(FreeError::NotExcited)?;
        let errors = Errors::of_simulation(moments, &fitted.theta, &explained.runs(self), &fitted.whitening);
        let figures = figures(moments, errors.variance, OutputUnits::OWN);
        Ok(normalise(&fitted.theta, fitted.structure, &fitted.basis, errors.covariance.as_ref(), figures))
    }

    /// The Cramér–Rao bound of an input's parameters, as standard deviations in the order `a`, `b`, descending border, ascending border in
    /// the normalisation `u_M − u_m = 1`, from a noise-free `output` that the grid explains, and its moments. The noise of the output is
    /// `w/D` with `D = 1 + d₁q⁻¹ + …` of the coefficients `whitening` and `w` white and normal with variance `variance`.
    ///
    /// ```text
    /// bound = variance · (Σ J Jᵀ)⁻¹,   J = D ∂ŷ/∂θ
    /// ```
    ///
    /// # Errors
    /// [`FreeError::NotExcited`] if the input leaves a parameter open.
    pub fn free_run_bound(
        &self,
        output: Output<'_>,
        moments: &Moments,
        whitening: &[f64],
        variance: f64,
    ) -> Result<Vec<f64>, FreeError> {
        let explained = Explained::of(output, self);
        let fitted =
            first_fit(self, &explained, FitKind::Simulation, moments).ok_or(FreeError::NotExcited)?;
        let information = explained.runs(self).information(fitted.structure, &fitted.theta, whitening);
        let covariance =
            Covariance::new(&information, &fitted.theta, variance).ok_or(FreeError::NotExcited)?;
        let quantities = quantities(&fitted.theta, &fitted.basis, OutputUnits::OWN);
        Ok(quantities.iter().map(|q| covariance.standard_error(&q.derivative)).collect())
    }
}

impl NestedRegressions {
    /// [`Self::estimate`] by fits of least free-run error; `moments` gives those of the output for the regression of a number.
    ///
    /// # Errors
    /// As [`Self::estimate`].
    pub fn free_run_estimate(
        &self,
        output: Output<'_>,
        moments: impl Fn(usize) -> Moments,
    ) -> Result<Estimate, FreeError> {
        let structure = self.regressions[0].grid().structure;
        let explained = Explained::of(output, &self.regressions[0]);
        let mut before: Option<Fitted> = None;
        let fits = self.on_grids().map_while(|(number, regression)| {
            let (moments, halved) = (moments(number), &self.regressions[number + 1]);
            let basis = regression.grid().basis.clone();
            let fitted = match before.take() {
                None => first_fit(regression, &explained, output.kind, &moments)?,
                Some(coarse) => {
                    let (start, runs) = (coarse.lifted(structure, &basis), explained.runs(regression));
                    simulated(&runs, start, (structure, basis), &coarse.whitening, output.kind)
                }
            };
            let Fitted { basis, theta, whitening, .. } = fitted.clone();
            let errors = Errors::of_simulation(&moments, &theta, &explained.runs(regression), &whitening);
            let on_halved = theta.on_basis(&basis, &halved.grid().basis);
            let halved_information = explained.runs(halved).information(structure, &on_halved, &whitening);
            before = Some(fitted);
            Some(GridFit { basis, theta, errors, halved_information, whitening })
        });
        let figures = figures(&moments(0), 0.0, OutputUnits::OWN);
        Ok(undersmoothed(structure, figures, fits).ok_or(FreeError::NotExcited)?.estimate)
    }
}

/// The fit that the equation error leads to.
fn first_fit(
    regression: &Regression,
    explained: &Explained,
    kind: FitKind,
    moments: &Moments,
) -> Option<Fitted> {
    let start = quick_equation_error_fit(moments)?;
    let grid = regression.grid();
    Some(simulated(&explained.runs(regression), start, (grid.structure, grid.basis.clone()), &[], kind))
}
