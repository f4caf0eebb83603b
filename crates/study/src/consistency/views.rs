//! Every figure over all replicates and over all but one section, so that whatever is drawn from several of them can be jackknifed.
//!
//! A section holds the same replicates in every cell, and cells of a sweep share their noise: a figure that joins cells (a slope, a ratio of
//! two methods' variances) leaves the same noise out of all of them at once, so its error knows how they go together.

use super::cell::CellTheory;
use super::sections::{CellSums, SECTIONS};
use crate::results::{Fitted, Measured};
use rayon::prelude::*;
use statrs::distribution::{ContinuousCDF, StudentsT};
use switchback_identify::statistics::{self, ErrorSums, Performance, jackknife_se};

/// All replicates, or all but one section.
pub(super) type View = Option<usize>;

/// What the replicates of a view say of one parameter.
#[derive(Debug, Clone, Copy)]
pub(super) struct Figures {
    pub(super) bias: statistics::Measured,
    pub(super) bias_controlled: Option<statistics::Measured>,
    pub(super) variance: f64,
    /// The same with the exactly known variance of the first-order part put in place of its sample variance.
    pub(super) variance_controlled: Option<f64>,
    /// Mean squared error.
    pub(super) mse: f64,
    pub(super) coverage: f64,
}

/// The figures of one cell's parameters in every view; `None` with fewer than two replicates.
#[derive(Debug)]
pub(super) struct CellViews {
    whole: Vec<Option<Figures>>,
    without: Vec<Vec<Option<Figures>>>,
}

/// The measures of each parameter of a cell in a view; those of methods of others with control variates that are adjusted by regression.
pub(super) fn performances(theory: &CellTheory, total: &CellSums, view: View) -> Vec<Option<Performance>> {
    let sums = total.parameters(view);
    let of = |(k, sums): (usize, &ErrorSums)| sums.performance(theory.known(k));
    let mut found: Vec<Option<Performance>> = sums.iter().enumerate().map(of).collect();
    let Some((foreign, (plan, noise))) = total.foreign().zip(theory.controls.as_ref()) else {
        return found;
    };
    let (controls, covariance) = (&foreign.controls, plan.covariance(noise));
    let adjusted = controls.adjusted(view, Some(&covariance)).unwrap_or_default();
    // Of all replicates but a section nobody asks for an error.
    let errors = view.is_none().then(|| controls.errors_of_sd(&covariance)).flatten();
    for (k, (found, adjusted)) in found.iter_mut().zip(adjusted).enumerate() {
        let Some(found) = found else { continue };
        found.bias_controlled = Some(adjusted.bias);
        let mcse = errors.as_ref().map_or(0.0, |errors| errors[k]);
        found.sd_controlled = adjusted.sd.map(|value| statistics::Measured { value, mcse });
    }
    for found in found.iter_mut().flatten().filter(|found| !found.model_sd.value.is_finite()) {
        // Without standard errors there are no intervals, and nothing to compare with the spread.
        (found.coverage.value, found.model_sd_relative_error.value) = (f64::NAN, f64::NAN);
    }
    found
}

/// One entry a cell.
pub(super) fn of_cells(theories: &[CellTheory], totals: &[CellSums]) -> Vec<CellViews> {
    theories.par_iter().zip(totals).map(|(theory, total)| CellViews::new(theory, total)).collect()
}

impl CellViews {
    fn new(theory: &CellTheory, total: &CellSums) -> Self {
        let figures = |view: View| {
            let performances = performances(theory, total, view);
            performances.into_iter().map(|found| found.map(Figures::from)).collect::<Vec<_>>()
        };
        let whole = figures(None);
        // A section without a replicate shows nothing of the spread.
        let enough = total.runs.replicates >= SECTIONS;
        let without = |section| if enough { figures(Some(section)) } else { vec![None; whole.len()] };
        Self { without: (0..SECTIONS).map(without).collect(), whole }
    }

    /// Parameter `k` in a view.
    pub(super) fn at(&self, view: View, k: usize) -> Option<Figures> {
        match view {
            None => self.whole[k],
            Some(section) => self.without[section][k],
        }
    }
}

impl Figures {
    /// Controlled where there is a control variate.
    pub(super) fn best_bias(&self) -> statistics::Measured {
        self.bias_controlled.unwrap_or(self.bias)
    }
}

impl From<Performance> for Figures {
    fn from(performance: Performance) -> Self {
        Self {
            bias: performance.bias,
            bias_controlled: performance.bias_controlled,
            variance: performance.sd.value * performance.sd.value,
            variance_controlled: performance.sd_controlled.map(|sd| sd.value * sd.value),
            mse: performance.mse.value,
            coverage: performance.coverage.value,
        }
    }
}

/// A figure with its jackknifed standard error.
#[derive(Debug, Clone, Copy)]
pub(super) struct Jackknifed {
    pub(super) value: f64,
    pub(super) se: f64,
}

impl Jackknifed {
    /// Computes a figure over all replicates and over all but each section; `None` where it does not exist in each of these views.
    pub(super) fn of(figure: impl Fn(View) -> Option<f64>) -> Option<Self> {
        let value = figure(None)?;
        let leave_one_out: Option<Vec<f64>> = (0..SECTIONS).map(|section| figure(Some(section))).collect();
        Some(Self { value, se: jackknife_se(&leave_one_out?)? })
    }

    pub(super) fn interval(self, quantile: f64) -> Option<Fitted> {
        Fitted::new(self.value, (self.value - quantile * self.se, self.value + quantile * self.se))
    }

    pub(super) fn measured(self) -> Option<Measured> {
        Measured::new(self.value, self.se)
    }
}

/// Two-sided quantile of Student's t with the degrees of freedom of the jackknife.
pub(super) fn quantile(error: f64) -> f64 {
    StudentsT::new(0.0, 1.0, (SECTIONS - 1) as f64)
        .map_or(f64::INFINITY, |t| t.inverse_cdf(1.0 - error / 2.0))
}

/// The mean; `None` of nothing.
pub(super) fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}
