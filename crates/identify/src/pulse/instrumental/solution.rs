//! The estimate from the folds, read as a system.

use super::STEPS;
use super::colour::{Colour, power};
use super::problem::{DIFFERENCE, Part, Problem};
use crate::LevelErrors;
use crate::pulse::data::PulseData;
use crate::pulse::experiments::Experiments;
use crate::pulse::fit::{Estimated, PulseFit, PulseFitError};
use crate::pulse::folds::Folds;
use crate::pulse::grouped::GroupedStatistics;
use crate::pulse::joint;
use crate::pulse::lanes::FoldControl;
use nalgebra::{Cholesky, DMatrix, DVector, DVectorView, Dyn};

/// The law of the output's noise, where it is known: `σ C/D w`, `w` unit white.
#[derive(Debug, Clone, Copy)]
pub(crate) struct KnownColour<'a> {
    /// `d₁…`
    pub(crate) ar: &'a [f64],
    /// `c₁…`
    pub(crate) ma: &'a [f64],
    /// `σ`.
    pub(crate) sigma: f64,
}

impl KnownColour<'_> {
    /// `σ²/S(ω)`.
    fn weight(&self, omega: f64) -> f64 {
        power(self.ar, omega) / power(self.ma, omega)
    }
}

/// The estimate with all that is reported of it.
#[derive(Debug, Clone)]
pub(crate) struct FoldedSolution {
    order: usize,
    /// Values of `a`, `b`, then the borders' points.
    values: Vec<f64>,
    /// Their derivatives in the parameters, a row each.
    gradients: DMatrix<f64>,
    /// The gain, `y` held at `u_M` and at `u_m`: value and derivative.
    levels: [DVector<f64>; 3],
    /// Covariance of the parameters over [`Self::variance`].
    inverse: DMatrix<f64>,
    /// Of the source of the noise.
    variance: f64,
    problem: Problem,
    theta: DVector<f64>,
    /// How the reported values move with each mean, experiment by experiment: a row a value. See [`Self::with_responses`].
    responses: Vec<DMatrix<f64>>,
    /// The means that were solved, about [`Self::reference`].
    means: Vec<Vec<f64>>,
    reference: f64,
    points: Vec<usize>,
    noise_sd: f64,
    u_low: f64,
}

/// Refined instrumental variables on the folds of one experiment or both; see the [module](super).
///
/// The start takes the folds for a record of one period, over which the lagged outputs are hardly noisy: `joint`'s regression, then rank one. From there
/// [`STEPS`] of Gauss and Newton.
///
/// # Errors
/// [`PulseFitError::NotPeriodic`] if the experiments have no folds, else [`PulseFitError`] if they do not excite every parameter.
///
/// # Panics
/// If no experiment is given.
pub(crate) fn instrumental(
    experiments: &[&PulseData],
    known: Option<KnownColour<'_>>,
) -> Result<FoldedSolution, PulseFitError> {
    let order = experiments[0].order();
    let reference = experiments[0].reference;
    let about: Vec<PulseData> = experiments.iter().map(|data| data.about(reference)).collect();
    let folded = about.iter().map(|data| Some((data, data.folds.as_ref()?))).collect::<Option<Vec<_>>>();
    let folded = folded.ok_or(PulseFitError::NotPeriodic)?;
    if folded.iter().any(|(_, folds)| folds.samples < 2.0 * folds.period() as f64) {
        return Err(PulseFitError::NotPeriodic);
    }
    let gamma = autocovariances(&folded);
    let colour = Colour::through(&gamma);
    let (problem, variance) = match known {
        None => (Problem::new(&folded, order, |omega| colour.weight(omega)), colour.variance()),
        Some(known) => (Problem::new(&folded, order, |omega| known.weight(omega)), known.sigma * known.sigma),
    };
    let mut theta = start(&problem, &folded)?;
    let mut factor = step(&problem, &mut theta)?;
    for _ in 1..STEPS {
        factor = step(&problem, &mut theta)?;
    }
    FoldedSolution::new(problem, theta, &factor, variance, &gamma, &folded)
}

/// The autocovariances of the output's noise: `Σ V_k / Σ (N − T)` over the experiments.
fn autocovariances(folded: &[(&PulseData, &Folds)]) -> Vec<f64> {
    let freedom: f64 = folded.iter().map(|(_, folds)| folds.samples - folds.period() as f64).sum();
    let lags = folded.iter().map(|(_, folds)| folds.within.len()).min().unwrap_or(0);
    let sum = |k: usize| folded.iter().map(|(_, folds)| folds.within[k]).sum::<f64>();
    (0..lags).map(|k| sum(k) / freedom.max(1.0)).collect()
}

/// The parameters by `joint`'s regression on the folds as records of one period each, then rank one.
fn start(problem: &Problem, folded: &[(&PulseData, &Folds)]) -> Result<DVector<f64>, PulseFitError> {
    let n = problem.order;
    let periods: Vec<PulseData> = folded.iter().map(|(data, folds)| one_period(data, folds)).collect();
    let experiments = Experiments::new(&periods.iter().collect::<Vec<_>>());
    let layout = joint::layout(&experiments);
    let fit = experiments.solve(&layout.columns)?;
    let mut theta = DVector::zeros(problem.size());
    theta.rows_mut(0, 2 * n).copy_from(&fit.core.rows(0, 2 * n));
    theta[2 * n] = fit.core[2 * n] / (1.0 + fit.core.rows(0, n).sum());
    for (part, rules) in problem.parts.iter().zip(&layout.levels) {
        for (level, rule) in rules.iter().enumerate() {
            if let Some(place) = part.place(level) {
                theta[place] = rule.read(&fit, n).0;
            }
        }
    }
    Ok(theta)
}

/// One period of the mean output as an experiment of its own.
fn one_period(data: &PulseData, folds: &Folds) -> PulseData {
    let (n, period) = (data.order(), folds.period());
    let back = |p: usize, lag: usize| (p + period * lag - lag) % period;
    let mut statistics = GroupedStatistics::new(n, 1 + data.points() * n);
    for p in 0..period {
        let seen = (1..=n).find_map(|lag| Some((folds.visits[back(p, lag)]?, lag)));
        let group = seen.map_or(0, |(level, lag)| PulseData::group(n, level, lag));
        let window: Vec<f64> = (0..=n).map(|lag| folds.means[back(p, lag)]).collect();
        statistics.push(group, &window);
    }
    PulseData {
        reference: data.reference,
        ..PulseData::from_statistics(data.branch, data.levels.clone(), data.satellite, statistics)
    }
}

/// Moves `theta` by one step; the factor of the information.
fn step(problem: &Problem, theta: &mut DVector<f64>) -> Result<Cholesky<f64, Dyn>, PulseFitError> {
    let equations = problem.equations(theta);
    let scale = equations.normal.diagonal();
    let factor = Cholesky::new(equations.normal).ok_or(PulseFitError::NotExcited)?;
    let l = factor.l_dirty();
    // A pivot that kept less than 1e-14 of its column's energy lost all its digits to the others.
    if !scale.iter().enumerate().all(|(i, s)| l[(i, i)] * l[(i, i)] > 1e-14 * s) {
        return Err(PulseFitError::NotExcited);
    }
    *theta += factor.solve(&equations.right);
    Ok(factor)
}

impl FoldedSolution {
    fn new(
        problem: Problem,
        theta: DVector<f64>,
        factor: &Cholesky<f64, Dyn>,
        variance: f64,
        gamma: &[f64],
        folded: &[(&PulseData, &Folds)],
    ) -> Result<Self, PulseFitError> {
        let (n, size) = (problem.order, problem.size());
        let reference = folded[0].0.reference;
        let (a_at_one, b_at_one) = (1.0 + theta.rows(0, n).sum(), theta.rows(n, n).sum());
        if b_at_one == 0.0 || !b_at_one.is_finite() {
            return Err(PulseFitError::NoGain);
        }
        let y_low = theta[2 * n] + reference;
        let u_low = y_low * a_at_one / b_at_one;
        let gradient = |of_a: f64, of_b: f64, of_o: f64| {
            let mut gradient = DVector::zeros(size);
            gradient.rows_mut(0, n).fill(of_a);
            gradient.rows_mut(n, n).fill(of_b);
            gradient[2 * n] = of_o;
            gradient
        };
        let base = gradient(y_low / b_at_one, -u_low / b_at_one, a_at_one / b_at_one);
        let point = |part: &Part, level: usize| {
            let mut gradient = base.clone();
            if let Some(place) = part.place(level) {
                gradient[place] = 1.0;
            }
            (u_low + part.level(&theta, level), gradient)
        };
        let coefficients = (0..2 * n).map(|k| {
            let mut gradient = DVector::zeros(size);
            gradient[k] = 1.0;
            (theta[k], gradient)
        });
        let points = problem.parts.iter().flat_map(|part| (0..part.points()).map(move |j| (part, j)));
        let (values, gradients): (Vec<f64>, Vec<DVector<f64>>) =
            coefficients.chain(points.map(|(part, j)| point(part, j))).unzip();
        let gradients = DMatrix::from_fn(values.len(), size, |i, j| gradients[i][j]);
        let gain = b_at_one / a_at_one;
        let of_gain = gradient(-gain / a_at_one, 1.0 / a_at_one, 0.0);
        let of_low = gradient(0.0, 0.0, 1.0);
        Ok(Self {
            order: n,
            values,
            gradients,
            levels: [of_gain.clone(), &of_gain + &of_low, of_low],
            inverse: factor.inverse(),
            variance,
            responses: Vec::new(),
            means: folded.iter().map(|(_, folds)| folds.means.clone()).collect(),
            reference,
            points: problem.parts.iter().map(Part::points).collect(),
            noise_sd: equation_error(&theta.as_slice()[..n], gamma),
            u_low,
            problem,
            theta,
        })
    }

    /// Ready to show its [first-order terms](Self::first_order).
    pub(crate) fn with_responses(self) -> Self {
        let to_parameters = &self.gradients * &self.inverse;
        let rights = self.problem.right_of_means(&self.theta);
        let responses = rights.iter().map(|right| &to_parameters * right).collect();
        Self { responses, ..self }
    }

    /// The estimate with its standard errors.
    pub(crate) fn fit(&self) -> PulseFit {
        let n = self.order;
        let se = |gradient: &DVector<f64>| (self.variance * gradient.dot(&(&self.inverse * gradient))).sqrt();
        let [gain, y_high, y_low] = self.levels.each_ref().map(se);
        let rows = self.values.iter().enumerate();
        let mut estimated =
            rows.map(|(k, &value)| Estimated { value, se: se(&self.gradients.row(k).transpose()) });
        PulseFit {
            a: estimated.by_ref().take(n).collect(),
            b: estimated.by_ref().take(n).collect(),
            borders: self.points.iter().map(|&m| estimated.by_ref().take(m).collect()).collect(),
            noise_sd: self.noise_sd,
            u_low: self.u_low,
            level_errors: LevelErrors { gain, y_high, y_low },
        }
    }

    /// Covariance of `a`, `b`, then the borders' points, row by row.
    pub(crate) fn covariance(&self) -> Vec<Vec<f64>> {
        let covariance = &self.gradients * &self.inverse * self.gradients.transpose() * self.variance;
        covariance.row_iter().map(|row| row.iter().copied().collect()).collect()
    }

    /// The bias of every reported value from records of `samples` samples each, but for terms of order `1/N²`; `solved` is how many the statistics
    /// that were solved stand for. With `Γ` the covariance of the parameters (Box, "Bias in nonlinear estimation", Journal of the Royal
    /// Statistical Society B 33 (1971), 171–201),
    ///
    /// ```text
    /// E[θ̂] − θ = −½ M⁻¹ Σ_k c_k Re(∂Z_k* tr(∂²Z_k Γ)),   M = Σ_k c_k Re(∂Z_k* ∂Z_k)
    /// ```
    ///
    /// and `½ tr(∂²g Γ)` more for a value `g` that is not linear in them. The weights' own error is a quadratic of the noise, which the means do not
    /// go together with where it is Gaussian; that of the start vanishes from the second order after the second step.
    pub(crate) fn second_order(&self, solved: f64, samples: f64) -> Vec<f64> {
        let covariance = &self.inverse * (self.variance * solved / samples);
        let Some(factor) = Cholesky::new(covariance) else { return vec![f64::NAN; self.values.len()] };
        let directions = factor.l();
        let mean = &self.inverse * self.problem.curvature(&self.theta, &directions) * -0.5;
        let low = |theta: &DVector<f64>| {
            let n = self.order;
            let y_low = theta[2 * n] + self.reference;
            y_low * (1.0 + theta.rows(0, n).sum()) / theta.rows(n, n).sum()
        };
        let bend = |along: DVectorView<'_, f64>| {
            let h = DIFFERENCE / along.amax();
            let (above, below) = (low(&(&self.theta + along * h)), low(&(&self.theta - along * h)));
            0.5 * (above + below - 2.0 * low(&self.theta)) / (h * h)
        };
        let bent: f64 = directions.column_iter().map(bend).sum();
        let linear = &self.gradients * mean;
        let own = |k: usize| if k < 2 * self.order { 0.0 } else { bent };
        linear.iter().enumerate().map(|(k, mean)| mean + own(k)).collect()
    }

    /// First-order change of every reported value when these experiments replace those that were solved: linear in their means.
    pub(crate) fn first_order(&self, experiments: &[&PulseData]) -> Vec<f64> {
        let mut first = DVector::zeros(self.values.len());
        for ((response, means), data) in self.responses.iter().zip(&self.means).zip(experiments) {
            let Some(folds) = data.folds.as_ref() else { return vec![f64::NAN; self.values.len()] };
            let shift = data.reference - self.reference;
            let change = folds.means.iter().zip(means).map(|(new, old)| new + shift - old);
            first += response * DVector::from_iterator(means.len(), change);
        }
        first.as_slice().to_vec()
    }

    /// [`Self::first_order`] as a constant map of the means, of an output about zero.
    pub(crate) fn control(&self) -> FoldControl {
        let of_part = |(k, (response, means)): (usize, (&DMatrix<f64>, &Vec<f64>))| -> f64 {
            response.row(k).iter().zip(means).map(|(r, z)| r * (z + self.reference)).sum()
        };
        let rest = |k: usize| self.responses.iter().zip(&self.means).map(|part| of_part((k, part))).sum();
        let row = |k: usize| {
            self.responses
                .iter()
                .flat_map(move |response| response.row(k).iter().copied().collect::<Vec<_>>())
        };
        let count = self.values.len();
        FoldControl { responses: (0..count).flat_map(row).collect(), rest: (0..count).map(rest).collect() }
    }

    /// The standard deviations of [`Self::first_order`], given the covariance of two means of one experiment, by their phases.
    pub(crate) fn first_order_sd(&self, covariance: impl Fn(usize, usize) -> f64) -> Vec<f64> {
        let mut variances = vec![0.0; self.values.len()];
        for response in &self.responses {
            let period = response.ncols();
            let together = DMatrix::from_fn(period, period, &covariance);
            let spread = response * together;
            for (k, variance) in variances.iter_mut().enumerate() {
                *variance += spread.row(k).dot(&response.row(k));
            }
        }
        variances.into_iter().map(f64::sqrt).collect()
    }
}

/// Standard deviation of `A(q⁻¹)e(t)`, `e` with these autocovariances; of as many of them as there are.
fn equation_error(a: &[f64], gamma: &[f64]) -> f64 {
    let coefficient = |i: usize| if i == 0 { 1.0 } else { a[i - 1] };
    let pairs = (0..=a.len()).flat_map(|i| (0..=a.len()).map(move |j| (i, j)));
    let term =
        |(i, j): (usize, usize)| coefficient(i) * coefficient(j) * gamma.get(i.abs_diff(j)).unwrap_or(&0.0);
    pairs.map(term).sum::<f64>().max(0.0).sqrt()
}
