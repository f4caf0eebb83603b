//! A solved regression read as a system: its parameters, their derivatives and their errors.

use super::arrow::{ArrowFit, Columns, Gradient, Response};
use super::data::{PulseData, StepMean};
use super::experiments::Experiments;
use super::fit::{Estimated, PulseFit, PulseFitError};
use super::grouped::GroupedStatistics;
use super::layout::Layout;
use super::level_rule::LevelRule;
use super::score::{Covariance, ErrorTerms};
use crate::LevelErrors;
use nalgebra::DVector;
use switchback_model::hysteresis::Branch;

/// How the absolute level of the borders was found.
#[derive(Debug, Clone)]
pub(crate) enum Level {
    /// From the constant column `κ`, the last core parameter; levels are relative to `u_m`.
    Constant,
    /// From a step experiment; levels are relative to the satellite's.
    Step(StepMean),
}

/// A reported parameter: its value, its derivative in the regression's parameters and, in total, in `ŷ₀`.
#[derive(Debug, Clone)]
pub(super) struct Quantity {
    pub(super) value: f64,
    pub(super) gradient: Gradient,
    pub(super) step_slope: f64,
}

/// A regression over pulse experiments, solved, with all that is reported of it: `a`, `b`, then the borders' points.
///
/// ```text
/// constant column:  F(V_j) = w_j + κ/B(1),            κ about the reference r: κ = κ' + A(1)·r
/// step experiment:  F(V_j) = f_j + A(1)/B(1)·ŷ₀       (3.25)
/// ```
///
/// Standard errors follow by the delta method; with a step experiment the error `δ` of `ŷ₀` (variance `σ²/(A(1)²L)`) enters both directly
/// and through the regression on `ỹ = y − ŷ₀`, whose residual it leaves at `−A(1)·δ`.
#[derive(Debug, Clone)]
pub(crate) struct Solution {
    pub(super) columns: Columns,
    pub(super) fit: ArrowFit,
    pub(super) level: Level,
    pub(super) order: usize,
    pub(super) reference: f64,
    /// How each border point is read, one list an experiment.
    levels: Vec<Vec<LevelRule>>,
    pub(super) quantities: Vec<Quantity>,
    /// How all parameters move with the step experiment's mean.
    pub(super) step_response: Option<Response>,
    /// The gain, and `y` at rest at `u_M` and at `u_m`.
    at_rest: [Quantity; 3],
    u_low: f64,
}

impl Solution {
    /// Solves a regression over the experiments and reads it.
    ///
    /// # Errors
    /// [`PulseFitError`] if the experiments do not excite every parameter.
    pub(crate) fn of(
        experiments: &Experiments<'_>,
        layout: Layout,
        level: Level,
    ) -> Result<Self, PulseFitError> {
        let fit = experiments.solve(&layout.columns)?;
        Self::new(experiments, layout, fit, level)
    }

    /// Reads a solved regression with core `(a, b[, κ])`.
    ///
    /// # Errors
    /// [`PulseFitError::NoGain`] if `B̂(1)` vanishes.
    pub(crate) fn new(
        experiments: &Experiments<'_>,
        Layout { columns, levels }: Layout,
        fit: ArrowFit,
        level: Level,
    ) -> Result<Self, PulseFitError> {
        let n = experiments.order();
        let b_at_one: f64 = fit.core.rows(n, n).sum();
        if b_at_one == 0.0 || !b_at_one.is_finite() {
            return Err(PulseFitError::NoGain);
        }
        let base = Base::of(&fit, n, experiments.reference, &level);
        let u_low = match (&level, experiments.parts[0].branch) {
            (Level::Step(_), Branch::Descending) => base.value - 1.0,
            _ => base.value,
        };
        let coefficients = (0..2 * n).map(|k| {
            let mut core = DVector::zeros(fit.core.len());
            core[k] = 1.0;
            (fit.core[k], Gradient { core, local: Vec::new() }, 0.0)
        });
        let border_points = levels.iter().flatten().map(|rule| {
            let (relative, mut gradient) = rule.read(&fit, n);
            gradient.core += &base.core;
            (base.value + relative, gradient, base.step)
        });
        let through = match level {
            Level::Constant => None,
            Level::Step(_) => Some(fit.response_to_constant(&experiments.statistics, &columns)),
        };
        let a_at_one = 1.0 + fit.core.rows(0, n).sum();
        let quantity = |(value, gradient, direct): (f64, Gradient, f64)| {
            let step_slope = through.as_ref().map_or(0.0, |r| direct - a_at_one * r.along(&gradient));
            Quantity { value, gradient, step_slope }
        };
        let quantities = coefficients.chain(border_points).map(quantity).collect();
        let gain = b_at_one / a_at_one;
        let mut of_gain = DVector::zeros(fit.core.len());
        of_gain.rows_mut(0, n).fill(-gain / a_at_one);
        of_gain.rows_mut(n, n).fill(1.0 / a_at_one);
        let held = |u: f64| (gain * u, &base.core * gain + &of_gain * u, gain * base.step);
        let at_rest = [(gain, of_gain.clone(), 0.0), held(u_low + 1.0), held(u_low)]
            .map(|(value, core, direct)| quantity((value, Gradient { core, local: Vec::new() }, direct)));
        Ok(Self {
            columns,
            fit,
            level,
            order: n,
            reference: experiments.reference,
            levels,
            quantities,
            step_response: through.map(|r| r.times(-a_at_one)),
            at_rest,
            u_low,
        })
    }

    /// The estimate with its standard errors.
    pub(crate) fn fit(&self) -> PulseFit {
        let n = self.order;
        let step_variance = self.step_variance();
        let se = |quantity: &Quantity| {
            let through_step = quantity.step_slope * quantity.step_slope * step_variance;
            (self.fit.variance_of(&quantity.gradient) + through_step).sqrt()
        };
        let [gain, y_high, y_low] = self.at_rest.each_ref().map(se);
        let mut estimated =
            self.quantities.iter().map(|quantity| Estimated { value: quantity.value, se: se(quantity) });
        PulseFit {
            a: estimated.by_ref().take(n).collect(),
            b: estimated.by_ref().take(n).collect(),
            borders: self
                .levels
                .iter()
                .map(|points| estimated.by_ref().take(points.len()).collect())
                .collect(),
            noise_sd: self.fit.variance.sqrt(),
            u_low: self.u_low,
            level_errors: LevelErrors { gain, y_high, y_low },
        }
    }

    /// How each border point is read, in the order of [`Self::quantities`].
    pub(super) fn rules(&self) -> impl Iterator<Item = LevelRule> + '_ {
        self.levels.iter().flatten().copied()
    }

    /// Covariance of `a`, `b`, then the borders' points, row by row.
    pub(crate) fn covariance(&self) -> Vec<Vec<f64>> {
        let gradients: Vec<&Gradient> = self.quantities.iter().map(|q| &q.gradient).collect();
        let mut rows = self.fit.covariances_of(&gradients);
        let step_variance = self.step_variance();
        for (row, one) in rows.iter_mut().zip(&self.quantities) {
            for (entry, other) in row.iter_mut().zip(&self.quantities) {
                *entry += one.step_slope * other.step_slope * step_variance;
            }
        }
        rows
    }

    /// Variance of `ŷ₀`.
    fn step_variance(&self) -> f64 {
        match self.level {
            Level::Constant => 0.0,
            Level::Step(step) => {
                let a_at_one = 1.0 + self.fit.core.rows(0, self.order).sum();
                self.fit.variance / (a_at_one * a_at_one * step.samples)
            }
        }
    }

    /// First-order change of every quantity (`a`, `b`, borders) when these experiments replace those that were solved, and of the second order
    /// the whole, given what was solved, or else what their profile score adds.
    ///
    /// `M⁻¹s` carried through the derivatives; `M` and the parameters are this solution's, the score `s` is that of the experiments given.
    pub(crate) fn terms(
        &self,
        experiments: &[&PulseData],
        step: Option<StepMean>,
        solved: Option<&GroupedStatistics>,
    ) -> ErrorTerms {
        let statistics = self.about_own(experiments);
        let change = self.step_change(step);
        let second = match solved {
            Some(expected) => self.second_order_term(&statistics, expected, change),
            None => self.along_quantities(&self.fit.profile_shift(&statistics, &self.columns)),
        };
        ErrorTerms { first: self.first_order_term(&statistics, change), second }
    }

    /// The means of [`Self::terms`] over all noise, given the means of the statistics and how their group sums vary together.
    pub(crate) fn mean_terms(
        &self,
        expected: &[&PulseData],
        step: Option<StepMean>,
        covariance: Covariance<'_>,
    ) -> ErrorTerms {
        let statistics = self.about_own(expected);
        let shift = self.fit.mean_profile_shift(&statistics, &self.columns, covariance);
        ErrorTerms {
            first: self.first_order_term(&statistics, self.step_change(step)),
            second: self.along_quantities(&shift),
        }
    }

    fn first_order_term(&self, statistics: &GroupedStatistics, step_change: f64) -> Vec<f64> {
        let first = self.fit.response_to_score(statistics, &self.columns);
        self.quantities.iter().map(|q| first.along(&q.gradient) + q.step_slope * step_change).collect()
    }

    /// What a right-hand side of the core makes of every quantity.
    fn along_quantities(&self, right: &DVector<f64>) -> Vec<f64> {
        let response = self.fit.respond_to_core(right);
        self.quantities.iter().map(|q| response.along(&q.gradient)).collect()
    }

    /// How far another mean of a step experiment is from the one that was used.
    fn step_change(&self, step: Option<StepMean>) -> f64 {
        match (&self.level, step) {
            (Level::Step(own), Some(other)) => other.mean - own.mean,
            _ => 0.0,
        }
    }

    /// The experiments side by side, about the reference of this solution.
    pub(super) fn about_own(&self, experiments: &[&PulseData]) -> GroupedStatistics {
        let about: Vec<GroupedStatistics> =
            experiments.iter().map(|data| data.about(self.reference).statistics).collect();
        GroupedStatistics::stacked(&about.iter().collect::<Vec<_>>())
    }
}

/// The base of the levels: `u` where the relative level is zero, with its derivatives in the core and in `ŷ₀`.
pub(super) struct Base {
    pub(super) value: f64,
    pub(super) core: DVector<f64>,
    pub(super) step: f64,
}

impl Base {
    pub(super) fn of(fit: &ArrowFit, n: usize, reference: f64, level: &Level) -> Self {
        let a_at_one = 1.0 + fit.core.rows(0, n).sum();
        let b_at_one: f64 = fit.core.rows(n, n).sum();
        let mut core = DVector::zeros(fit.core.len());
        let (held, output) = match level {
            Level::Constant => {
                core[2 * n] = 1.0 / b_at_one;
                (fit.core[2 * n] + a_at_one * reference, reference)
            }
            Level::Step(step) => (a_at_one * step.mean, step.mean),
        };
        for i in 0..n {
            core[i] = output / b_at_one;
            core[n + i] = -held / (b_at_one * b_at_one);
        }
        Self { value: held / b_at_one, core, step: a_at_one / b_at_one }
    }
}
