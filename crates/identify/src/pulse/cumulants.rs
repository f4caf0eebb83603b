//! How far the first-order part of an error is from normal.

use super::arrow::Gradient;
use super::method::{Limit, Solved};
use super::second_order::{EquationNoise, ExpectedRecord, InverseForm, Phases};
use super::solution::{Level, Quantity, Solution};
use nalgebra::Complex;
use statrs::distribution::{Continuous, ContinuousCDF, Normal};
use std::f64::consts::TAU;

/// Skewness and excess kurtosis of the first-order part of a parameter's error.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Cumulants {
    /// `κ₃/sd³`, of order `N^(−1/2)`.
    pub skewness: f64,
    /// `κ₄/sd⁴`, of order `1/N`.
    pub kurtosis: f64,
}

impl Cumulants {
    /// The chance that it lies within `z` standard deviations of zero, but for terms of order `1/N²`: Edgeworth's expansion
    ///
    /// ```text
    /// 2Φ(z) − 1 − 2φ(z) (κ₄/24 (z³ − 3z) + κ₃²/72 (z⁵ − 10z³ + 15z))
    /// ```
    ///
    /// P. Hall, "The Bootstrap and Edgeworth Expansion" (1992), section 2.3.
    pub fn chance_within(&self, z: f64) -> f64 {
        let normal = Normal::standard();
        let cube = z * z * z;
        let of_kurtosis = self.kurtosis / 24.0 * (cube - 3.0 * z);
        let of_skewness = self.skewness * self.skewness / 72.0 * (cube * z * z - 10.0 * cube + 15.0 * z);
        2.0 * normal.cdf(z) - 1.0 - 2.0 * normal.pdf(z) * (of_kurtosis + of_skewness)
    }
}

impl Limit {
    /// The cumulants of the first-order part of every parameter's error, for records and noise as in [`Limit::finite_sample`].
    ///
    /// That part is a quadratic in the normal noise `w`, with `x = M⁻¹∇g`, `p = xᵀφ̄` periodic, and `h` the impulse response of `1/A`,
    ///
    /// ```text
    /// c = σ Σ_t p(t) w(t) + wᵀQw,     Q_ts = −½σ² Σᵢ xᵢ h(|t−s|−i)
    /// κ_r = 2^(r−1) (r−1)! (tr Qʳ + ¼r σ² pᵀQʳ⁻²p)
    /// ```
    ///
    /// `Q` is a Toeplitz matrix with the symbol `q(θ) = −σ² Re Σᵢ xᵢ exp(−iθi)/A(exp(iθ))`, so that `tr Qʳ` is `N` times the mean of `qʳ`, and
    /// `pᵀQʳp` is `N/T²` times the sum of `|P_k|² qʳ(2πk/T)` over the Fourier coefficients of a period: both but for the edges of the record,
    /// which are of relative order `1/N`.
    ///
    /// # Panics
    /// If there are not as many records as the method has experiments.
    pub fn cumulants(&self, records: &[ExpectedRecord<'_>], noise: EquationNoise<'_>) -> Vec<Cumulants> {
        let solution = match &self.solution {
            Solved::Regression(solution) => solution,
            // Linear in the noise.
            Solved::Folds(_) => {
                let none = Cumulants { skewness: 0.0, kurtosis: 0.0 };
                return vec![none; self.fit().parameters().count()];
            }
        };
        let step_variance = match solution.level {
            Level::Constant => 0.0,
            Level::Step(_) => noise.sigma * noise.sigma * noise.memory.mean_variance(records[0].samples),
        };
        let sds = self.first_order_sd(noise.sigma, step_variance);
        let sums = solution.third_and_fourth(records, noise);
        let standardised = |([third, fourth], sd): ([f64; 2], f64)| Cumulants {
            skewness: third / sd.powi(3),
            kurtosis: fourth / sd.powi(4),
        };
        sums.into_iter().zip(sds).map(standardised).collect()
    }
}

impl Solution {
    /// `κ₃` and `κ₄` of every quantity.
    fn third_and_fourth(&self, records: &[ExpectedRecord<'_>], noise: EquationNoise<'_>) -> Vec<[f64; 2]> {
        let n = self.order;
        let inverse = InverseForm::of(&self.fit);
        let a: Vec<f64> = self.fit.core.rows(0, n).iter().copied().collect();
        let grid = Symbol::new(&a, (4 * noise.memory.length()).next_power_of_two());
        let mut sums = vec![[0.0; 2]; self.quantities.len()];
        let mut first = 0;
        for record in records {
            let phases = Phases::of(&self.fit, &self.columns, (record, first, self.reference));
            let harmonics = Symbol::new(&a, record.groups.len());
            for (sums, quantity) in sums.iter_mut().zip(&self.quantities) {
                let of = OfRecord { inverse: &inverse, phases: &phases, grid: &grid, harmonics: &harmonics };
                let more = of.third_and_fourth(quantity, record.samples as f64, noise.sigma);
                sums.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
            }
            first += 1 + record.groups.iter().max().copied().unwrap_or(0);
        }
        sums
    }
}

/// What one record adds.
struct OfRecord<'a> {
    inverse: &'a InverseForm<'a>,
    phases: &'a Phases<'a>,
    grid: &'a Symbol,
    harmonics: &'a Symbol,
}

impl OfRecord<'_> {
    fn third_and_fourth(&self, quantity: &Quantity, samples: f64, sigma: f64) -> [f64; 2] {
        let Gradient { local, .. } = &quantity.gradient;
        let x = self.inverse.core_of(&quantity.gradient);
        let variance = sigma * sigma;
        let symbol = |at: &Symbol| at.along(x.as_slice()).map(|q| -variance * q).collect::<Vec<f64>>();
        let on_grid = symbol(self.grid);
        let mean = |power: i32| on_grid.iter().map(|q| q.powi(power)).sum::<f64>() / on_grid.len() as f64;
        let p = self.phases.along(&x, local);
        let period = p.len();
        let mut linear = [0.0; 2];
        for (k, q) in symbol(self.harmonics).into_iter().enumerate() {
            let harmonic: Complex<f64> =
                p.iter().enumerate().map(|(t, p)| self.harmonics.turns[k * t % period] * *p).sum();
            linear[0] += harmonic.norm_sqr() * q;
            linear[1] += harmonic.norm_sqr() * q * q;
        }
        let scale = variance * samples / (period * period) as f64;
        [
            8.0 * samples * mean(3) + 6.0 * scale * linear[0],
            48.0 * samples * mean(4) + 48.0 * scale * linear[1],
        ]
    }
}

/// `Re exp(−iθl)/A(exp(iθ))` at equally spaced `θ`, for each lag `l`.
struct Symbol {
    lags: usize,
    /// Lags of the first angle, then of the next.
    values: Vec<f64>,
    /// `exp(−iθ)`.
    turns: Vec<Complex<f64>>,
}

impl Symbol {
    fn new(a: &[f64], angles: usize) -> Self {
        let turns: Vec<Complex<f64>> =
            (0..angles).map(|k| Complex::from_polar(1.0, -TAU * k as f64 / angles as f64)).collect();
        let mut values = Vec::with_capacity(angles * a.len());
        for turn in &turns {
            let mut polynomial = Complex::new(1.0, 0.0);
            let mut power = *turn;
            for a in a {
                polynomial += power * *a;
                power *= *turn;
            }
            let mut response = *turn / polynomial;
            for _ in a {
                values.push(response.re);
                response *= *turn;
            }
        }
        Self { lags: a.len(), values, turns }
    }

    /// `Σ_l x_l` times it, at every angle.
    fn along(&self, x: &[f64]) -> impl Iterator<Item = f64> + '_ {
        let x: Vec<f64> = x[..self.lags].to_vec();
        self.values
            .chunks_exact(self.lags)
            .map(move |row| row.iter().zip(&x).map(|(value, x)| value * x).sum())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pulse::{PulseData, PulseMethod, StepMean};
    use crate::simulation::{NoiseMoments, PeriodicDesign, periodic_response, superpose};
    use nalgebra::{DMatrix, DVector};
    use switchback_model::hysteresis::Branch;
    use switchback_model::linear::{LinearSystem, NoiseMemory};

    /// One descendant experiment of three levels on a system of order one.
    fn limit(samples: usize, sigma: f64) -> (Limit, PeriodicDesign, Vec<f64>, NoiseMemory) {
        let system = LinearSystem::new(vec![-0.6], vec![0.4]).expect("stable");
        let u = vec![1.0, 1.0, 0.0, 1.0, 0.3, 1.0, 0.7, 1.0, 1.0];
        let levels = vec![-1.0, -0.4, 0.4];
        let group = |t: usize| match (t + 8) % 9 {
            2 => 1,
            4 => 2,
            6 => 3,
            _ => 0,
        };
        let groups = (0..9).map(group).collect();
        let response = periodic_response(&system, &u);
        let design =
            PeriodicDesign { branch: Branch::Descending, levels, satellite: 1.0, order: 1, u, groups };
        let moments = NoiseMoments::expected_over(system.a(), &[], 1, 9, samples);
        let data: PulseData = superpose(&design, &response, sigma, &moments);
        let step = StepMean { mean: system.static_gain(), samples: samples as f64 };
        let limit = Limit::of(PulseMethod::Paper { experiment: &data, step }).expect("excited");
        (limit, design, response, NoiseMemory::of(system.a()))
    }

    /// The cumulants with `Q` and `p` written out.
    fn dense(limit: &Limit, record: &ExpectedRecord<'_>, noise: EquationNoise<'_>) -> Vec<Cumulants> {
        let Solved::Regression(solution) = &limit.solution else {
            unreachable!("the method is a regression")
        };
        let inverse = InverseForm::of(&solution.fit);
        let phases = Phases::of(&solution.fit, &solution.columns, (record, 0, solution.reference));
        let (samples, period) = (record.samples, record.groups.len());
        let variance = noise.sigma * noise.sigma;
        let of = |quantity: &Quantity| {
            let x = inverse.core_of(&quantity.gradient);
            // The noise before the record begins belongs to it.
            let before = noise.memory.length();
            let size = before + samples;
            let q = DMatrix::from_fn(size, size, |t, s| match t.abs_diff(s) {
                0 => 0.0,
                apart if t.max(s) >= before => -0.5 * variance * x[0] * noise.memory.impulse(apart - 1),
                _ => 0.0,
            });
            let along = phases.along(&x, &quantity.gradient.local);
            let p = DVector::from_fn(size, |t, _| {
                if t < before { 0.0 } else { noise.sigma * along[(t - before) % period] }
            });
            let (square, through) = (&q * &q, &q * &p);
            let step = quantity.step_slope.powi(2) * variance * noise.memory.mean_variance(samples);
            let second = 2.0 * square.trace() + p.norm_squared() + step;
            let third = 8.0 * (&square * &q).trace() + 6.0 * p.dot(&through);
            let fourth = 48.0 * square.norm_squared() + 48.0 * through.norm_squared();
            Cumulants { skewness: third / second.powf(1.5), kurtosis: fourth / (second * second) }
        };
        solution.quantities.iter().map(of).collect()
    }

    #[test]
    fn the_cumulants_are_those_of_the_quadratic_form_but_for_its_edges() {
        let sigma = 0.3;
        let apart = |samples: usize| {
            let (limit, design, response, memory) = limit(samples, sigma);
            let record = ExpectedRecord { groups: &design.groups, response: &response, samples };
            let noise = EquationNoise { sigma, memory: &memory };
            let (fast, slow) = (limit.cumulants(&[record], noise), dense(&limit, &record, noise));
            let of = |get: fn(&Cumulants) -> f64| {
                let differences = fast.iter().zip(&slow).map(|(f, s)| (get(f) - get(s)).abs());
                differences.fold(0.0, f64::max) / slow.iter().map(|s| get(s).abs()).fold(0.0, f64::max)
            };
            [of(|c| c.skewness), of(|c| c.kurtosis)]
        };
        let (short, long) = (apart(90), apart(360));
        for (short, long) in short.into_iter().zip(long) {
            assert!(short < 0.2 && long < 0.3 * short, "{short} {long}");
        }
    }

    #[test]
    fn the_chance_is_that_of_a_mean_of_squares() {
        // The standardised sum of n squares of normals: κ₃ = √(8/n), κ₄ = 12/n; P by its own distribution.
        let within = |n: f64| {
            let square = statrs::distribution::ChiSquared::new(n).expect("freedom");
            let reach = 1.96 * (2.0 * n).sqrt();
            square.cdf(n + reach) - square.cdf(n - reach)
        };
        let error = |n: f64| {
            let cumulants = Cumulants { skewness: (8.0 / n).sqrt(), kurtosis: 12.0 / n };
            (cumulants.chance_within(1.96) - within(n)).abs()
        };
        // The next term is of order 1/n².
        assert!(error(50.0) < 2e-3 && error(200.0) < error(50.0) / 12.0, "{} {}", error(50.0), error(200.0));
    }
}
