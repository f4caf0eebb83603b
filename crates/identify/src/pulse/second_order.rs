//! The mean of a regression's error to second order in the noise.

use super::arrow::{ArrowFit, Columns, Gradient, Response};
use nalgebra::{DMatrix, DVector};
use switchback_model::linear::NoiseMemory;

/// A pulse experiment before it is taken: what every sample will hold but for the noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExpectedRecord<'a> {
    /// The group (see [`PulseData`](super::PulseData)) of each phase of the period.
    pub groups: &'a [usize],
    /// The noise-free output at each phase.
    pub response: &'a [f64],
    /// Samples `N` that enter the regression, from phase 0 on; the last period may be a part of one.
    pub samples: usize,
}

/// The equation error `σw` and what it leaves in the output, `σw/A`.
#[derive(Debug, Clone, Copy)]
pub struct EquationNoise<'a> {
    /// `σ`.
    pub sigma: f64,
    /// `1/A`.
    pub memory: &'a NoiseMemory,
}

/// A right-hand side of the normal equations: `Σ_{t∈q} x(t)` a group and `−Σ_t y(t−i) x(t)` a lag.
#[derive(Debug, Clone, PartialEq)]
struct Target {
    residual: Vec<f64>,
    lagged: Vec<f64>,
}

/// A quadratic form in the inverse normal matrix, `xᵀM⁻¹y`.
#[derive(Debug, Clone)]
pub(super) struct InverseForm<'a> {
    fit: &'a ArrowFit,
    /// `M⁻¹` on the core, the local columns eliminated.
    core: DMatrix<f64>,
}

impl<'a> InverseForm<'a> {
    pub(super) fn of(fit: &'a ArrowFit) -> Self {
        Self { fit, core: fit.factor.inverse() }
    }

    /// `xᵀM⁻¹y` of two derivatives.
    pub(super) fn at(&self, x: &Gradient, y: &Gradient) -> f64 {
        let own = self.fit.product_of_locals(x, y);
        own + self.fit.through_core(x).dot(&(&self.core * self.fit.through_core(y)))
    }

    /// `M⁻¹x` on the core.
    pub(super) fn core_of(&self, x: &Gradient) -> DVector<f64> {
        &self.core * self.fit.through_core(x)
    }
}

impl ArrowFit {
    /// The mean of the parameters' error to second order in the noise, where the parameters are the true ones and `M` is this normal matrix.
    ///
    /// With `φ` the regressors at the true parameters, `φ = φ̄ + φ̃`, the error is `M⁻¹s` to first order, `s = Σφξ`, and to second
    ///
    /// ```text
    /// −M⁻¹ ((Σφφᵀ − M) M⁻¹s + ½ Σ φ̄ (M⁻¹s)ᵀ H (M⁻¹s))   (+ a term of mean zero that cancels another)
    /// ```
    ///
    /// `H` the second derivative of a group's mean, which is not zero where the columns are bilinear only (Box 1971). The mean of the first
    /// part is a sum over all pairs of samples `t > s`; as `ξ(s)` goes together with later outputs only, Isserlis' theorem leaves
    ///
    /// ```text
    /// E[φ_t φ_tᵀ M⁻¹ φ_s ξ_s] = w φ̄_tᵀM⁻¹φ̄_s + φ̄_t wᵀM⁻¹φ̄_s + w tr(M⁻¹Γ) + Γ M⁻¹w
    /// w = E[φ̃_t ξ_s] = −σ²(h(t−s−i))_i,   Γ = E[φ̃_t φ̃_sᵀ] = σ²(γ(t−s+l−i))_i,l
    /// ```
    ///
    /// (Kiviet and Phillips 1993 for one lag). Every pair within the `N` samples counts as often as it occurs, so that the result is the
    /// exact mean of the second-order term. `O(n T L)` for a period of `T` samples and a memory of `L`.
    pub(super) fn second_order_mean(
        &self,
        columns: &Columns,
        reference: f64,
        records: &[ExpectedRecord<'_>],
        noise: EquationNoise<'_>,
    ) -> Response {
        let inverse = InverseForm::of(self);
        let mut target =
            Target { residual: vec![0.0; columns.offset.len()], lagged: vec![0.0; self.lags(columns)] };
        let curvature = self.curvature(columns, &inverse.core, noise.sigma);
        let mut groups = 0;
        for record in records {
            let phases = Phases::of(self, columns, (record, groups, reference));
            let ahead = &inverse.core * &phases.reduced;
            let mut along = phases.noise_with_response(noise, &ahead, &mut target.lagged);
            for (p, along) in along.iter_mut().enumerate() {
                *along += phases.count(p) * curvature[phases.group(p)];
            }
            phases.project(&along, &mut target);
            noise_with_noise(noise, record.samples, &inverse.core, &mut target.lagged);
            groups += 1 + record.groups.iter().max().copied().unwrap_or(0);
        }
        self.respond(columns, &target.residual, &target.lagged).times(-1.0)
    }

    /// The mean, to second order, of the parameters' error through that of a constant taken from the output, per variance of the constant.
    ///
    /// `A(1)δ` is then missing in the output and `δ` in every lag; `slope` is the parameters' derivative in `δ`.
    pub(super) fn constant_mean(
        &self,
        columns: &Columns,
        reference: f64,
        record: &ExpectedRecord<'_>,
        slope: &Response,
    ) -> Response {
        let phases = Phases::of(self, columns, (record, 0, reference));
        let n = self.lags(columns);
        let a_at_one = 1.0 + self.core.rows(0, n).sum();
        let lags_move: f64 = slope.core.rows(0, n).sum();
        let sum = phases.total(columns);
        let along = slope.along(&sum);
        let mut target = Target { residual: vec![0.0; columns.offset.len()], lagged: vec![0.0; n] };
        phases.project(
            &(0..record.groups.len()).map(|p| -lags_move * phases.count(p)).collect::<Vec<_>>(),
            &mut target,
        );
        target.lagged.iter_mut().for_each(|l| *l -= record.samples as f64 * a_at_one + along);
        self.respond(columns, &target.residual, &target.lagged)
    }

    fn lags(&self, columns: &Columns) -> usize {
        self.core.len() - columns.shared.ncols()
    }

    /// `½σ² tr(H M⁻¹)` a group: `H` has a one for every pair of a level and the `b` of the lag that sees it.
    fn curvature(&self, columns: &Columns, inverse: &DMatrix<f64>, sigma: f64) -> Vec<f64> {
        let n = self.lags(columns);
        let mut curvature = vec![0.0; columns.offset.len()];
        if columns.bilinear {
            for (column, tie) in columns.local.iter().zip(&self.ties) {
                for (i, &(q, _)) in column.support.iter().enumerate() {
                    curvature[q] = -sigma * sigma * inverse.row(n + i).transpose().dot(&tie.slope);
                }
            }
        }
        curvature
    }
}

/// The regressors of an experiment without the noise, phase for phase.
pub(super) struct Phases<'a> {
    record: &'a ExpectedRecord<'a>,
    /// Its first group among those of all experiments.
    first: usize,
    /// `z(p−i)` about the reference, a column a phase.
    lags: DMatrix<f64>,
    /// The core's regressors with the local columns eliminated, a column a phase.
    reduced: DMatrix<f64>,
    /// The local column of each phase with its weight there.
    local: Vec<Option<(usize, f64)>>,
    /// `D` of each local column.
    own: Vec<f64>,
}

impl<'a> Phases<'a> {
    pub(super) fn of(
        fit: &ArrowFit,
        columns: &Columns,
        (record, first, reference): (&'a ExpectedRecord<'a>, usize, f64),
    ) -> Self {
        let (n, p) = (fit.lags(columns), columns.shared.ncols());
        let period = record.groups.len();
        let mut of_group = vec![None; columns.offset.len()];
        for (l, column) in columns.local.iter().enumerate() {
            column.support.iter().for_each(|&(q, w)| of_group[q] = Some((l, w)));
        }
        let lags = DMatrix::from_fn(n, period, |i, t| {
            record.response[(t + n * period - i - 1) % period] - reference
        });
        let local: Vec<_> = record.groups.iter().map(|q| of_group[first + q]).collect();
        let mut reduced = DMatrix::zeros(n + p, period);
        for t in 0..period {
            let mut column = reduced.column_mut(t);
            for i in 0..n {
                column[i] = -lags[(i, t)];
            }
            for k in 0..p {
                column[n + k] = columns.shared[(first + record.groups[t], k)];
            }
            if let Some((l, w)) = local[t] {
                column.axpy(-w, &fit.ties[l].slope, 1.0);
            }
        }
        let own = fit.ties.iter().map(|tie| tie.own).collect();
        Self { record, first, lags, reduced, local, own }
    }

    fn period(&self) -> usize {
        self.record.groups.len()
    }

    fn group(&self, phase: usize) -> usize {
        self.first + self.record.groups[phase]
    }

    /// Samples of a phase.
    fn count(&self, phase: usize) -> f64 {
        ((self.record.samples + self.period() - 1 - phase) / self.period()) as f64
    }

    /// `φ̄_pᵀM⁻¹φ̄_r`.
    fn product(&self, ahead: &DMatrix<f64>) -> DMatrix<f64> {
        let mut product = self.reduced.tr_mul(ahead);
        for (p, of_p) in self.local.iter().enumerate() {
            for (r, of_r) in self.local.iter().enumerate() {
                if let (Some((l, w)), Some((k, v))) = (of_p, of_r)
                    && l == k
                {
                    product[(p, r)] += w * v / self.own[*l];
                }
            }
        }
        product
    }

    /// `xᵀM⁻¹φ̄_p` of every phase, given `M⁻¹x` on the core and the derivative's local part.
    pub(super) fn along(&self, core: &DVector<f64>, local: &[(usize, f64)]) -> Vec<f64> {
        let own = |p: usize| {
            let Some((l, w)) = self.local[p] else { return 0.0 };
            local.iter().filter(|(k, _)| *k == l).map(|(_, weight)| weight * w / self.own[l]).sum::<f64>()
        };
        (0..self.period()).map(|p| self.reduced.column(p).dot(core) + own(p)).collect()
    }

    /// `Σ w φ̄_tᵀM⁻¹φ̄_s`, added to the lags; returns `Σ wᵀM⁻¹φ̄_s` of each phase of `t`.
    fn noise_with_response(
        &self,
        EquationNoise { sigma, memory }: EquationNoise<'_>,
        ahead: &DMatrix<f64>,
        lagged: &mut [f64],
    ) -> Vec<f64> {
        let (n, period) = (lagged.len(), self.period());
        let product = self.product(ahead);
        let mut along = vec![0.0; period];
        // Samples of each phase that come k after another one.
        let mut later: Vec<f64> = (0..period).map(|p| self.count(p)).collect();
        for k in 1..=(memory.length() + n).min(self.record.samples.saturating_sub(1)) {
            later[(k - 1) % period] -= 1.0;
            let w: Vec<f64> = weights(sigma, memory, n, k).collect();
            let mut sum = 0.0;
            for (p, (along, count)) in along.iter_mut().zip(&later).enumerate() {
                let before = (p + period - k % period) % period;
                sum += count * product[(p, before)];
                let column = ahead.column(before);
                *along += count * w.iter().zip(column.iter()).map(|(w, x)| w * x).sum::<f64>();
            }
            lagged.iter_mut().zip(&w).for_each(|(lagged, w)| *lagged += w * sum);
        }
        along
    }

    /// Adds a target that is `values` in the sum over each phase.
    fn project(&self, values: &[f64], target: &mut Target) {
        for (p, value) in values.iter().enumerate() {
            target.residual[self.group(p)] += value;
            for (i, lagged) in target.lagged.iter_mut().enumerate() {
                *lagged -= self.lags[(i, p)] * value;
            }
        }
    }

    /// `Σφ̄` over the record.
    fn total(&self, columns: &Columns) -> Gradient {
        let (n, p) = (self.lags.nrows(), columns.shared.ncols());
        let mut core = DVector::zeros(n + p);
        let mut local = vec![0.0; columns.local.len()];
        for phase in 0..self.period() {
            let count = self.count(phase);
            for i in 0..n {
                core[i] -= count * self.lags[(i, phase)];
            }
            for k in 0..p {
                core[n + k] += count * columns.shared[(self.group(phase), k)];
            }
            if let Some((l, w)) = self.local[phase] {
                local[l] += count * w;
            }
        }
        Gradient { core, local: local.into_iter().enumerate().collect() }
    }
}

/// `w_i = −σ²h(k−i)`, `i = 1…n`.
fn weights(sigma: f64, memory: &NoiseMemory, n: usize, k: usize) -> impl Iterator<Item = f64> + '_ {
    (1..=n).map(move |i| if k < i { 0.0 } else { -sigma * sigma * memory.impulse(k - i) })
}

/// `Σ (w tr(M⁻¹Γ) + Γ M⁻¹w)` over all pairs of samples, added to the lags.
fn noise_with_noise(
    EquationNoise { sigma, memory }: EquationNoise<'_>,
    samples: usize,
    inverse: &DMatrix<f64>,
    lagged: &mut [f64],
) {
    let n = lagged.len();
    for k in 1..=(memory.length() + n).min(samples.saturating_sub(1)) {
        let pairs = (samples - k) as f64;
        let w: Vec<f64> = weights(sigma, memory, n, k).collect();
        let gamma = |i: usize, l: usize| sigma * sigma * memory.covariance((k + l).abs_diff(i));
        let ahead: Vec<f64> = (0..n).map(|l| (0..n).map(|j| inverse[(l, j)] * w[j]).sum()).collect();
        let trace: f64 = (0..n * n).map(|c| inverse[(c / n, c % n)] * gamma(c / n, c % n)).sum();
        for (i, lagged) in lagged.iter_mut().enumerate() {
            let through: f64 = (0..n).map(|l| gamma(i, l) * ahead[l]).sum();
            *lagged += pairs * (w[i] * trace + through);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pulse::GroupedStatistics;
    use crate::simulation::periodic_response;
    use proptest::prelude::*;
    use switchback_model::linear::LinearSystem;

    /// A regression at its expected statistics: `N` samples, a period of `response.len()`, a group a phase, these input columns.
    fn at_expectation(
        a: &[f64],
        (response, samples): (&[f64], usize),
        shared: DMatrix<f64>,
        sigma: f64,
    ) -> (ArrowFit, Columns) {
        let (n, period) = (a.len(), response.len());
        let memory = NoiseMemory::of(a);
        let width = n + 1;
        let counts: Vec<f64> = (0..period).map(|p| ((samples + period - 1 - p) / period) as f64).collect();
        let z = |p: usize, l: usize| response[(p + n * period - l) % period];
        let sums = (0..period * width).map(|k| counts[k / width] * z(k / width, k % width)).collect();
        let products = (0..width * width)
            .map(|k| {
                let (i, l) = (k / width, k % width);
                let of_noise = samples as f64 * sigma * sigma * memory.covariance(i.abs_diff(l));
                of_noise + (0..period).map(|p| counts[p] * z(p, i) * z(p, l)).sum::<f64>()
            })
            .collect();
        let columns = Columns { shared, local: Vec::new(), offset: vec![0.0; period], bilinear: false };
        let statistics = GroupedStatistics::from_parts(n, counts, sums, products);
        (ArrowFit::solve(&statistics, &columns).expect("excited"), columns)
    }

    fn mean(
        a: &[f64],
        (response, samples): (&[f64], usize),
        shared: DMatrix<f64>,
        sigma: f64,
    ) -> DVector<f64> {
        let (fit, columns) = at_expectation(a, (response, samples), shared, sigma);
        let groups: Vec<usize> = (0..response.len()).collect();
        let record = ExpectedRecord { groups: &groups, response, samples };
        let memory = NoiseMemory::of(a);
        fit.second_order_mean(&columns, 0.0, &[record], EquationNoise { sigma, memory: &memory }).core
    }

    /// `lim N·E(â − a)` of an autoregression, with a constant or without: A. L. Pope, "Biases of estimators in multivariate non-Gaussian
    /// autoregressions", Journal of Time Series Analysis 11 (1990), 249–258, on the companion form `y_t = F y_{t−1} + …`:
    ///
    /// ```text
    /// −G [(I − Fᵀ)⁻¹ + Fᵀ(I − Fᵀ²)⁻¹ + Σ_λ λ(I − λFᵀ)⁻¹] Γ(0)⁻¹
    /// ```
    ///
    /// The first term belongs to the constant; the sum over the eigenvalues is `Σ_k tr(Fᵏ⁺¹)(Fᵀ)ᵏ`.
    fn pope(a: &[f64], constant: bool) -> Vec<f64> {
        let n = a.len();
        let forward =
            DMatrix::from_fn(n, n, |i, j| if i == 0 { -a[j] } else { f64::from(u8::from(i == j + 1)) });
        let (back, identity) = (forward.transpose(), DMatrix::identity(n, n));
        let mut sum = &back * (&identity - &back * &back).try_inverse().expect("stable");
        if constant {
            sum += (&identity - &back).try_inverse().expect("stable");
        }
        let (mut power, mut powered) = (identity, forward.clone());
        for _ in 0..3_000 {
            sum += &power * powered.trace();
            power *= &back;
            powered *= &forward;
        }
        let memory = NoiseMemory::of(a);
        let gamma = DMatrix::from_fn(n, n, |i, j| memory.covariance(i.abs_diff(j)));
        let bias = sum * gamma.try_inverse().expect("a covariance");
        // Row 0 of −G(…), for φ = −a.
        (0..n).map(|j| bias[(0, j)]).collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(60))]

        #[test]
        fn a_pure_autoregression_has_the_bias_that_is_published(
            reflection in prop::collection::vec(-0.8..0.8_f64, 1..=4), sigma in 0.1..3.0_f64, constant in any::<bool>(),
        ) {
            // Step-up recursion: every stable autoregression.
            let mut a: Vec<f64> = Vec::new();
            for k in reflection {
                let before = a.clone();
                (0..before.len()).for_each(|i| a[i] += k * before[before.len() - 1 - i]);
                a.push(k);
            }
            let samples = 100_000_000;
            let shared = DMatrix::from_element(1, usize::from(constant), 1.0);
            let mean = mean(&a, (&[0.0], samples), shared, sigma);
            let published = pope(&a, constant);
            for (i, expected) in published.iter().enumerate() {
                let found = mean[i] * samples as f64;
                prop_assert!((found - expected).abs() < 1e-4 * (1.0 + expected.abs()), "a{}: {} against {}", i + 1, found, expected);
            }
            // P. Shaman and R. A. Stine, "The bias of autoregressive coefficient estimators", Journal of the American Statistical Association 83
            // (1988), 842–848; the first line is M. G. Kendall's, "Note on bias in the estimation of autocorrelation", Biometrika 41 (1954), 403–404.
            let table = match (a.as_slice(), constant) {
                (&[a], false) => vec![-2.0 * a],
                (&[a], true) => vec![1.0 - 3.0 * a],
                (&[a, b], false) => vec![-a, 1.0 - 3.0 * b],
                (&[a, b], true) => vec![1.0 - a - b, 2.0 - 4.0 * b],
                _ => published,
            };
            for (i, expected) in table.iter().enumerate() {
                prop_assert!((mean[i] * samples as f64 - expected).abs() < 1e-4 * (1.0 + expected.abs()));
            }
        }

        #[test]
        fn one_lag_and_an_input_have_the_bias_of_kiviet_and_phillips(
            pole in -0.85..0.85_f64, gain in 0.2..2.0_f64, sigma in 0.1..2.0_f64, u in prop::collection::vec(-1.0..1.0_f64, 3..7),
        ) {
            let spread = u.iter().fold(f64::MIN, |m, x| m.max(*x)) - u.iter().fold(f64::MAX, |m, x| m.min(*x));
            prop_assume!(spread > 0.5);
            let period = u.len();
            let system = LinearSystem::new(vec![-pole], vec![gain]).expect("stable");
            let response = periodic_response(&system, &u);
            let shared = DMatrix::from_fn(period, 2, |p, k| if k == 0 { u[(p + period - 1) % period] } else { 1.0 });
            let scaled = |periods: usize| {
                let samples = periods * period;
                let fast = mean(&[-pole], (&response, samples), shared.clone(), sigma);
                let slow = kiviet_phillips(pole, (&response, samples), &shared, sigma);
                // Theirs starts from a fixed output, ours from a stationary one: that is of order 1/N².
                let apart = (&fast - &slow).amax() * samples as f64;
                (apart, slow.amax() * samples as f64)
            };
            let (short, long) = (scaled(20), scaled(80));
            prop_assert!(long.0 < 0.1 * (1.0 + long.1) && long.0 < 0.4 * short.0 + 1e-6, "{:?} {:?}", short, long);
        }
    }

    /// `−σ² (QZ̄'CZ̄q₁ + tr(QZ̄'CZ̄) q₁ + 2σ² q₁₁ tr(CC'C) q₁)`, `Q = (Z̄'Z̄ + σ² tr(C'C) e₁e₁')⁻¹`, `C` holding the powers of the pole below its
    /// diagonal (equation 14 of J. F. Kiviet and G. D. A. Phillips, Econometric Theory 9 (1993), 62–80), for `φ₁ = −y(t−1)`.
    fn kiviet_phillips(
        pole: f64,
        (response, samples): (&[f64], usize),
        shared: &DMatrix<f64>,
        sigma: f64,
    ) -> DVector<f64> {
        let period = response.len();
        let z = DMatrix::from_fn(samples, 1 + shared.ncols(), |t, k| match k {
            0 => response[(t + period - 1) % period],
            _ => shared[(t % period, k - 1)],
        });
        let c = DMatrix::from_fn(
            samples,
            samples,
            |t, s| {
                if s < t { pole.powi((t - s - 1) as i32) } else { 0.0 }
            },
        );
        let variance = sigma * sigma;
        let mut information = z.tr_mul(&z);
        let cc = c.tr_mul(&c);
        information[(0, 0)] += variance * cc.trace();
        let q = information.try_inverse().expect("excited");
        let q1 = q.column(0).into_owned();
        let inner = &q * z.tr_mul(&(&c * &z));
        let last = 2.0 * variance * q[(0, 0)] * (&cc * &c).trace();
        let mut bias = -variance * (&inner * &q1 + &q1 * (inner.trace() + last));
        bias[0] = -bias[0];
        bias
    }
}
