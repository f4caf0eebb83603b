//! The whole second-order term of a replicate's error.

use super::arrow::Response;
use super::grouped::GroupedStatistics;
use super::solution::{Level, Solution};
use nalgebra::DVector;

impl Solution {
    /// The second-order part of every quantity's error, given the statistics of a replicate, their expectations that were solved, and the
    /// error `δ` of `ŷ₀` (0 where there is no step experiment); all about this solution's reference.
    ///
    /// With `d = M⁻¹s + τδ` the first-order change of the parameters, `φ = φ̄ + φ̃` the regressors, and `e` the deviation of the output,
    ///
    /// ```text
    /// M d₂ = −(Σφφᵀ − M) d                                           what the replicate's own normal matrix makes of the score
    ///        + δ 1_a Σξ − A(1)δ Σφ̃ − A(1)δ² N 1_a                    what is missing in y and in every lag with ŷ₀ off
    ///        + Σ (Hd)(ξ − φ̄ᵀd) − ½ Σ φ̄ dᵀHd                          where the columns are bilinear
    /// ```
    ///
    /// and a quantity `g` has `∇g d₂ + ½ dᵀ∇²g d`. It is half the second derivative of the estimate along the deviation of the statistics:
    /// exact, and quadratic in them. Where the model holds its mean is that of [`super::FiniteSampleTheory::bias`].
    pub(super) fn second_order_term(
        &self,
        statistics: &GroupedStatistics,
        expected: &GroupedStatistics,
        step_change: f64,
    ) -> Vec<f64> {
        let (fit, columns, n) = (&self.fit, &self.columns, self.order);
        let mut first = fit.response_to_score(statistics, columns);
        if let Some(slope) = &self.step_response {
            first = first.plus(&slope.clone().times(step_change));
        }
        let groups = statistics.groups();
        let a_at_one = 1.0 + fit.core.rows(0, n).sum();
        let residual = fit.residual_sums(statistics, columns);
        let deviation = |q: usize, lag: usize| statistics.sum(q, lag) - expected.sum(q, lag);
        let change = |i: usize, l: usize| {
            let of_step = step_change * (expected.total(i) + expected.total(l));
            statistics.product(i, l) - expected.product(i, l) - of_step
        };
        // How the mean of each group moves.
        let mut moved: Vec<f64> = (0..groups)
            .map(|q| (n..first.core.len()).map(|k| columns.shared[(q, k - n)] * first.core[k]).sum())
            .collect();
        for (column, local) in columns.local.iter().zip(&first.local) {
            column.support.iter().for_each(|&(q, w)| moved[q] += w * local);
        }
        let within = |q: usize, lag: usize| deviation(q, lag) - expected.count(q) * step_change;
        let mut along: Vec<f64> =
            (0..groups).map(|q| (1..=n).map(|l| within(q, l) * first.core[l - 1]).sum()).collect();
        let xi: f64 = residual.iter().sum();
        let mut lagged: Vec<f64> = (1..=n)
            .map(|i| {
                let products: f64 = (1..=n).map(|l| change(i, l) * first.core[l - 1]).sum();
                let sums: f64 = (0..groups).map(|q| within(q, i) * moved[q]).sum();
                let noise: f64 = (0..groups).map(|q| deviation(q, i)).sum();
                let missing = xi + a_at_one * (noise - step_change * expected.samples());
                sums - products + step_change * missing
            })
            .collect();
        let mut direct = Response { core: DVector::zeros(fit.core.len()), local: vec![0.0; fit.local.len()] };
        if columns.bilinear {
            for (l, column) in columns.local.iter().enumerate() {
                for (i, &(q, _)) in column.support.iter().enumerate() {
                    let (of_b, of_level) = (first.core[n + i], first.local[l]);
                    let past: f64 = (0..n).map(|k| expected.sum(q, k + 1) * first.core[k]).sum();
                    let left = residual[q] + past - expected.count(q) * moved[q];
                    direct.core[n + i] += of_level * left;
                    direct.local[l] += of_b * left;
                    along[q] -= expected.count(q) * of_b * of_level;
                    for (k, lagged) in lagged.iter_mut().enumerate() {
                        *lagged += expected.sum(q, k + 1) * of_b * of_level;
                    }
                }
            }
        }
        let second = fit.respond(columns, &along, &lagged).plus(&self.answer_to(&direct));
        let bend_of_base = self.bend_of_base(&first, step_change);
        let of_points = self.rules().map(|rule| {
            bend_of_base + rule.rank_one().map_or(0.0, |(l, _)| self.bend_of_rank_one(l, &first))
        });
        let bends = std::iter::repeat_n(0.0, 2 * n).chain(of_points);
        self.quantities.iter().zip(bends).map(|(q, bend)| second.along(&q.gradient) + bend).collect()
    }

    /// How the parameters answer to a right-hand side of the normal equations that is given column by column.
    fn answer_to(&self, right: &Response) -> Response {
        let fit = &self.fit;
        let mut core = right.core.clone();
        for (tie, target) in fit.ties.iter().zip(&right.local) {
            core.axpy(-target, &tie.slope, 1.0);
        }
        let core = fit.factor.solve(&core);
        let local = fit.ties.iter().zip(&right.local).map(|(tie, t)| t / tie.own - tie.slope.dot(&core));
        Response { local: local.collect(), core }
    }

    /// Half the curvature of the base of the levels along a change.
    fn bend_of_base(&self, first: &Response, step_change: f64) -> f64 {
        let n = self.order;
        let v: f64 = self.fit.core.rows(n, n).sum();
        let a_at_one = 1.0 + self.fit.core.rows(0, n).sum();
        let (of_a, of_v): (f64, f64) = (first.core.rows(0, n).sum(), first.core.rows(n, n).sum());
        let (u, of_u, own) = match self.level {
            Level::Constant => {
                let u = self.fit.core[2 * n] + a_at_one * self.reference;
                (u, first.core[2 * n] + self.reference * of_a, 0.0)
            }
            Level::Step(step) => {
                (a_at_one * step.mean, step.mean * of_a + a_at_one * step_change, of_a * step_change)
            }
        };
        bend_of_ratio((u, of_u, own), (v, of_v, 0.0))
    }

    /// The same of a level `Σᵢ bᵢhᵢ / Σᵢ bᵢ²` with free means from `l` on.
    fn bend_of_rank_one(&self, l: usize, first: &Response) -> f64 {
        let n = self.order;
        let (b, h) = (self.fit.core.rows(n, n), &self.fit.local[l..l + n]);
        let (of_b, of_h) = (first.core.rows(n, n), &first.local[l..l + n]);
        let sum = |f: &dyn Fn(usize) -> f64| (0..n).map(f).sum::<f64>();
        let u =
            (sum(&|i| b[i] * h[i]), sum(&|i| of_b[i] * h[i] + b[i] * of_h[i]), sum(&|i| of_b[i] * of_h[i]));
        bend_of_ratio(u, (b.norm_squared(), 2.0 * b.dot(&of_b), of_b.norm_squared()))
    }
}

/// The second-order part of a ratio: of numerator and denominator are given the value, the first-order part and the second.
fn bend_of_ratio((u, u1, u2): (f64, f64, f64), (v, v1, v2): (f64, f64, f64)) -> f64 {
    (u2 - u / v * v2 - u1 * v1 / v + u * v1 * v1 / (v * v)) / v
}
