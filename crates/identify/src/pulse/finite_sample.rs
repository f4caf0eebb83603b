//! What an estimate's bias and standard deviation are at a given number of samples.

use super::arrow::Gradient;
use super::method::{Limit, Solved};
use super::second_order::{EquationNoise, ExpectedRecord, InverseForm};
use super::solution::{Level, Quantity, Solution};
use nalgebra::DVector;

/// Theory of an estimate from `N` samples of each experiment; an entry a parameter: `a`, `b`, then the points of each border.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FiniteSampleTheory {
    /// The standard deviation of the first-order term: `√(∇g σ²M⁻¹ ∇gᵀ)`, `M` the information of the very `N` samples, whatever is left of the
    /// last period included. The estimate's differs from it by a share of order `1/N`.
    pub sd: Vec<f64>,
    /// The exact mean of the second-order term: the bias but for terms of order `1/N²`.
    pub bias: Vec<f64>,
}

impl Limit {
    /// Bias and standard deviation of the estimate from records of `N` samples each, for Gaussian white equation error.
    ///
    /// The limit is to be that of the expected statistics of the same records ([`crate::simulation::NoiseMoments::expected_over`]), and the
    /// model to hold, so that the parameters are the true ones. With `d = M⁻¹s` the first-order error of the regression's parameters `θ`, `d₂` the
    /// second-order one, and a reported parameter `g(θ)`,
    ///
    /// ```text
    /// sd²   = ∇g σ²M⁻¹ ∇gᵀ
    /// bias  = ∇g E[d₂] + ½ tr(∇²g σ²M⁻¹)
    /// ```
    ///
    /// The mean of a step experiment, where the method takes one, brings its variance and its own part of the bias. Derivation:
    /// `docs/theory.md`. References: Kiviet and Phillips, "Alternative bias approximations in regressions with a lagged-dependent variable",
    /// Econometric Theory 9 (1993), 62–80; Box, "Bias in nonlinear estimation", Journal of the Royal Statistical Society B 33 (1971), 171–201.
    ///
    /// Of [`PulseMethod::Instrumental`](super::PulseMethod::Instrumental) the standard deviations are the asymptotic ones ([`Limit::fold_sd`] has the
    /// exact ones of the first-order term), and the bias is that of the optimum for the noise whose colour the limit's statistics have; `noise`
    /// plays no part.
    ///
    /// # Panics
    /// If there are not as many records as the method has experiments.
    pub fn finite_sample(
        &self,
        records: &[ExpectedRecord<'_>],
        noise: EquationNoise<'_>,
    ) -> FiniteSampleTheory {
        match &self.solution {
            Solved::Regression(solution) => solution.finite_sample(records, noise),
            Solved::Folds(solution) => {
                let samples = records[0].samples as f64;
                let bias = solution.second_order(self.samples, samples);
                FiniteSampleTheory { sd: self.theory_se(samples), bias }
            }
        }
    }

    /// The standard deviations alone, given that of the equation error and the variance of a step experiment's mean (0 without one).
    pub fn first_order_sd(&self, sigma: f64, step_variance: f64) -> Vec<f64> {
        match &self.solution {
            Solved::Regression(solution) => FirstOrder::of(solution, sigma * sigma, step_variance).sd(),
            Solved::Folds(_) => self.fit().parameters().map(|x| x.se).collect(),
        }
    }
}

impl Solution {
    fn finite_sample(&self, records: &[ExpectedRecord<'_>], noise: EquationNoise<'_>) -> FiniteSampleTheory {
        let variance = noise.sigma * noise.sigma;
        let step_variance = match self.level {
            Level::Constant => 0.0,
            Level::Step(_) => variance * noise.memory.mean_variance(records[0].samples),
        };
        let mut mean = self.fit.second_order_mean(&self.columns, self.reference, records, noise);
        if let Some(slope) = &self.step_response {
            let moved = self.fit.constant_mean(&self.columns, self.reference, &records[0], slope);
            mean = mean.plus(&moved.times(step_variance));
        }
        let errors =
            FirstOrder { solution: self, inverse: InverseForm::of(&self.fit), variance, step_variance };
        let bend_of_base = errors.bend_of_base();
        let of_points = self.rules().map(|rule| {
            bend_of_base + rule.rank_one().map_or(0.0, |(first, _)| errors.bend_of_rank_one(first))
        });
        let bends = std::iter::repeat_n(0.0, 2 * self.order).chain(of_points);
        let bias =
            self.quantities.iter().zip(bends).map(|(q, bend)| mean.along(&q.gradient) + bend).collect();
        FiniteSampleTheory { sd: errors.sd(), bias }
    }
}

/// How the first-order errors of a solution's quantities vary together, and what curvature makes of them on average.
struct FirstOrder<'a> {
    solution: &'a Solution,
    inverse: InverseForm<'a>,
    /// `σ²`.
    variance: f64,
    /// Variance of `ŷ₀`.
    step_variance: f64,
}

impl<'a> FirstOrder<'a> {
    fn of(solution: &'a Solution, variance: f64, step_variance: f64) -> Self {
        Self { solution, inverse: InverseForm::of(&solution.fit), variance, step_variance }
    }

    fn sd(&self) -> Vec<f64> {
        self.solution.quantities.iter().map(|q| self.covariance(q, q).sqrt()).collect()
    }

    fn covariance(&self, x: &Quantity, y: &Quantity) -> f64 {
        self.variance * self.inverse.at(&x.gradient, &y.gradient)
            + x.step_slope * y.step_slope * self.step_variance
    }

    /// A quantity with this derivative in the parameters, and in `ŷ₀` itself.
    fn quantity(&self, gradient: Gradient, direct: f64) -> Quantity {
        let through = self.solution.step_response.as_ref().map_or(0.0, |r| r.along(&gradient));
        Quantity { value: 0.0, gradient, step_slope: direct + through }
    }

    /// A quantity linear in the core.
    fn of_core(&self, entries: impl IntoIterator<Item = (usize, f64)>, direct: f64) -> Quantity {
        let mut core = DVector::zeros(self.solution.fit.core.len());
        entries.into_iter().for_each(|(k, weight)| core[k] += weight);
        self.quantity(Gradient { core, local: Vec::new() }, direct)
    }

    /// Half the curvature of the base of the levels, `u/B(1)`, along its errors: `u = κ + A(1)r` or `A(1)ŷ₀`.
    fn bend_of_base(&self) -> f64 {
        let Solution { fit, order: n, reference, level, .. } = self.solution;
        let n = *n;
        let b_at_one: f64 = fit.core.rows(n, n).sum();
        let a_at_one = 1.0 + fit.core.rows(0, n).sum();
        let of_a = |weight: f64| (0..n).map(move |i| (i, weight));
        let gain = self.of_core((n..2 * n).map(|i| (i, 1.0)), 0.0);
        let (value, held, own) = match level {
            Level::Constant => {
                let held = self.of_core(of_a(*reference).chain([(2 * n, 1.0)]), 0.0);
                (fit.core[2 * n] + a_at_one * reference, held, 0.0)
            }
            Level::Step(step) => {
                let held = self.of_core(of_a(step.mean), a_at_one);
                let own = self.covariance(&self.of_core(of_a(1.0), 0.0), &self.of_core([], 1.0));
                (a_at_one * step.mean, held, own)
            }
        };
        ratio(value, b_at_one, [own, 0.0, self.covariance(&held, &gain), self.covariance(&gain, &gain)])
    }

    /// The same of a level `Σᵢ bᵢhᵢ / Σᵢ bᵢ²` with free means from `first` on.
    fn bend_of_rank_one(&self, first: usize) -> f64 {
        let Solution { fit, order: n, .. } = self.solution;
        let b = fit.core.rows(*n, *n);
        let h = &fit.local[first..first + n];
        let of_b = |i: usize| self.of_core([(n + i, 1.0)], 0.0);
        let of_h = |i: usize| {
            let gradient = Gradient { core: DVector::zeros(fit.core.len()), local: vec![(first + i, 1.0)] };
            self.quantity(gradient, 0.0)
        };
        let mut inner = self.of_core((0..*n).map(|i| (n + i, h[i])), 0.0).gradient;
        inner.local = (0..*n).map(|i| (first + i, b[i])).collect();
        let inner = self.quantity(inner, 0.0);
        let norm = self.of_core((0..*n).map(|i| (n + i, 2.0 * b[i])), 0.0);
        let second =
            |f: &dyn Fn(usize) -> Quantity| (0..*n).map(|i| self.covariance(&of_b(i), &f(i))).sum::<f64>();
        let value = b.iter().zip(h).map(|(b, h)| b * h).sum();
        let moments =
            [second(&of_h), second(&of_b), self.covariance(&inner, &norm), self.covariance(&norm, &norm)];
        ratio(value, b.norm_squared(), moments)
    }
}

/// The mean to second order of `u/v`, less `u/v`: given the means of the second-order parts of `u` and `v`, the covariance of the first-order
/// ones, and the variance of that of `v`.
fn ratio(u: f64, v: f64, [of_u, of_v, together, alone]: [f64; 4]) -> f64 {
    (of_u - u / v * of_v - together / v + u / (v * v) * alone) / v
}
