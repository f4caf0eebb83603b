//! `instrumental` by its definition: the model's response and its derivatives from dense circulant systems, weighted by the inverse covariance
//! of the means over periods.

use super::regression::{Experiment, Inner, Regression};
use super::solved::{Solved, slopes};
use nalgebra::{DMatrix, DVector};
use switchback_identify::pulse::{Folds, PulseFitError};

/// Gauss–Newton steps of the method.
const STEPS: usize = 2;

/// The mean output of one experiment over its periods, whitened as far as the noise's autoregression says.
struct Part {
    /// `w` at the satellite, and at `V₁`.
    rest: f64,
    first: f64,
    /// The level that the input visits at each phase.
    visits: Vec<Option<usize>>,
    points: usize,
    means: DVector<f64>,
    /// `√(N/T) D/√v`, circulant.
    whiten: DMatrix<f64>,
}

/// The estimate.
pub(super) struct Folded {
    order: usize,
    parts: Vec<Part>,
    /// `a`, `b`, the output held at `u_m`, then `w₂…w_m` of each experiment.
    theta: DVector<f64>,
    information: DMatrix<f64>,
}

/// What a record holds of one experiment: its means, and the sums of products that they leave.
struct Fold {
    means: Vec<f64>,
    left: Vec<f64>,
}

impl Folded {
    pub(super) fn of(
        experiments: &[&Experiment],
        order: usize,
        samples: usize,
    ) -> Result<Self, PulseFitError> {
        let folds: Vec<Fold> = experiments.iter().map(|e| fold(e, order, samples)).collect();
        let period = experiments[0].period;
        let freedom = (experiments.len() * (samples - period)) as f64;
        if samples < 2 * period {
            return Err(PulseFitError::NotPeriodic);
        }
        let gamma = |k: usize| folds.iter().map(|f| f.left[k]).sum::<f64>() / freedom;
        let toeplitz = |size: usize| DMatrix::from_fn(size, size, |i, j| gamma(i.abs_diff(j)));
        // On short records these may be the autocovariances of no process: then as many of them as are those of one.
        let are_of_a_process = |lags: &usize| toeplitz(lags + 1).cholesky().is_some();
        let lags = (0..folds[0].left.len()).rev().find(are_of_a_process).ok_or(PulseFitError::NotExcited)?;
        // The Yule–Walker equations, densely.
        let right = DVector::from_fn(lags, |i, _| -gamma(i + 1));
        let d = toeplitz(lags).lu().solve(&right).ok_or(PulseFitError::NotExcited)?;
        let variance = gamma(0) + (0..lags).map(|i| d[i] * gamma(i + 1)).sum::<f64>();
        let mut shift = DMatrix::zeros(period, period);
        (0..period).for_each(|p| shift[(p, (p + period - 1) % period)] = 1.0);
        let whiten =
            polynomial(&shift, 1.0, d.as_slice()) * (samples as f64 / (period as f64 * variance)).sqrt();
        let part = |(e, fold): (&&Experiment, &Fold)| Part {
            rest: e.rest(),
            first: 1.0 - e.rest(),
            visits: visits(e),
            points: e.levels.len(),
            means: DVector::from_column_slice(&fold.means),
            whiten: whiten.clone(),
        };
        let parts: Vec<Part> = experiments.iter().zip(&folds).map(part).collect();
        let theta = start(experiments, &folds, order)?;
        let size = theta.len();
        let mut folded = Self { order, parts, theta, information: DMatrix::zeros(size, size) };
        for _ in 0..STEPS {
            folded.step(&shift)?;
        }
        Ok(folded)
    }

    /// One Gauss–Newton step.
    fn step(&mut self, shift: &DMatrix<f64>) -> Result<(), PulseFitError> {
        let n = self.order;
        let size = self.theta.len();
        let a = polynomial(shift, 1.0, &self.theta.as_slice()[..n]);
        let b = polynomial(shift, 0.0, &self.theta.as_slice()[n..2 * n]);
        let a = a.lu();
        let respond = |x: &DVector<f64>| a.solve(x).ok_or(PulseFitError::NotExcited);
        let mut rows = DMatrix::zeros(0, size);
        let mut left = DVector::zeros(0);
        let mut own = 2 * n + 1;
        for part in &self.parts {
            let w = |level: usize| if level == 0 { part.first } else { self.theta[own + level - 1] };
            let u = DVector::from_iterator(
                part.visits.len(),
                part.visits.iter().map(|visit| visit.map_or(part.rest, w)),
            );
            let z = respond(&(&b * &u))?;
            let mut jacobian = DMatrix::zeros(u.len(), size);
            let (mut z_back, mut u_back) = (z.clone(), u.clone());
            for i in 0..n {
                (z_back, u_back) = (shift * z_back, shift * u_back);
                jacobian.set_column(i, &-respond(&z_back)?);
                jacobian.set_column(n + i, &respond(&u_back)?);
            }
            jacobian.column_mut(2 * n).fill(1.0);
            for level in 1..part.points {
                let at = |visit: &Option<usize>| f64::from(*visit == Some(level));
                let visits = DVector::from_iterator(u.len(), part.visits.iter().map(at));
                jacobian.set_column(own + level - 1, &respond(&(&b * visits))?);
            }
            let residual =
                &part.whiten * (&part.means - z - DVector::from_element(u.len(), self.theta[2 * n]));
            let (above, before) = (rows.nrows(), left.len());
            rows = rows.resize_vertically(above + u.len(), 0.0);
            rows.rows_mut(above, u.len()).copy_from(&(&part.whiten * jacobian));
            left = left.resize_vertically(before + u.len(), 0.0);
            left.rows_mut(before, u.len()).copy_from(&residual);
            own += part.points - 1;
        }
        let qr = rows.qr();
        let change = qr.r().solve_upper_triangular(&(qr.q().transpose() * left));
        let change = change.ok_or(PulseFitError::NotExcited)?;
        self.theta += &change;
        self.information = qr.r().transpose() * qr.r();
        Ok(())
    }

    /// Values and standard errors of `a`, `b` and the border points, by central differences.
    pub(super) fn estimates(&self) -> Result<Vec<(f64, f64)>, PulseFitError> {
        let covariance = self.information.clone().try_inverse().ok_or(PulseFitError::NotExcited)?;
        let at = |i: usize, x: f64| {
            let mut theta = self.theta.clone();
            theta[i] = x;
            self.read(&theta)
        };
        let columns: Vec<Vec<f64>> =
            (0..self.theta.len()).map(|i| slopes(|x| at(i, x), self.theta[i])).collect();
        let se = |k: usize| {
            let gradient = DVector::from_iterator(columns.len(), columns.iter().map(|column| column[k]));
            gradient.dot(&(&covariance * &gradient)).sqrt()
        };
        Ok(self.read(&self.theta).into_iter().enumerate().map(|(k, value)| (value, se(k))).collect())
    }

    fn read(&self, theta: &DVector<f64>) -> Vec<f64> {
        let n = self.order;
        let u_low = theta[2 * n] * (1.0 + theta.rows(0, n).sum()) / theta.rows(n, n).sum();
        let mut read: Vec<f64> = theta.rows(0, 2 * n).iter().copied().collect();
        let mut own = 2 * n + 1;
        for part in &self.parts {
            read.push(u_low + part.first);
            read.extend((0..part.points - 1).map(|j| u_low + theta[own + j]));
            own += part.points - 1;
        }
        read
    }
}

/// `c₀ + c₁q⁻¹ + … ` of a circulant shift.
fn polynomial(shift: &DMatrix<f64>, constant: f64, coefficients: &[f64]) -> DMatrix<f64> {
    let mut power = DMatrix::identity(shift.nrows(), shift.nrows());
    let mut sum = &power * constant;
    for c in coefficients {
        power = shift * power;
        sum += &power * *c;
    }
    sum
}

/// What the control variate is made of.
pub(super) fn means(e: &Experiment, order: usize, samples: usize) -> Folds {
    let Fold { means, left } = fold(e, order, samples);
    Folds { visits: visits(e), means, within: left, samples: samples as f64 }
}

/// The level that the input visits at each phase.
fn visits(e: &Experiment) -> Vec<Option<usize>> {
    let at = |p: usize| e.seen[(p + 1) % e.period].filter(|(_, lag)| *lag == 1).map(|(level, _)| level);
    (0..e.period).map(at).collect()
}

/// The means over the first `samples` samples, and the products of what they leave, by the definition.
fn fold(e: &Experiment, order: usize, samples: usize) -> Fold {
    let lags = e.before.len() + order;
    let y: Vec<f64> = e.before.iter().chain(&e.y).copied().take(lags + samples).collect();
    let mean = |p: usize, lag: usize| {
        let seen: Vec<f64> = (p..samples).step_by(e.period).map(|t| y[lags + t - lag]).collect();
        seen.iter().sum::<f64>() / seen.len() as f64
    };
    let left = (0..=lags).map(|lag| {
        let means: Vec<[f64; 2]> = (0..e.period).map(|p| [mean(p, 0), mean(p, lag)]).collect();
        let product = |t: usize| {
            let [now, back] = means[t % e.period];
            (y[lags + t] - now) * (y[lags + t - lag] - back)
        };
        (0..samples).map(product).sum()
    });
    Fold { left: left.collect(), means: (0..e.period).map(|p| mean(p, 0)).collect() }
}

/// Where the iteration begins: the regression of `joint` on the means as records of one period.
fn start(experiments: &[&Experiment], folds: &[Fold], order: usize) -> Result<DVector<f64>, PulseFitError> {
    let periods: Vec<Experiment> = experiments
        .iter()
        .zip(folds)
        .map(|(e, fold)| Experiment {
            branch: e.branch,
            levels: e.levels.clone(),
            satellite: e.satellite,
            before: Vec::new(),
            y: (0..e.period + order).map(|t| fold.means[(t + e.period * order - order) % e.period]).collect(),
            seen: e.seen[..e.period].to_vec(),
            period: e.period,
        })
        .collect();
    let regression =
        Regression::new(order, periods.iter().collect(), experiments[0].period, Inner::Free, None);
    let solved = Solved::of(regression)?;
    let theta = solved.theta();
    let held = theta[2 * order] / (1.0 + theta[..order].iter().sum::<f64>());
    let levels = solved.regression.levels(theta).into_iter().flat_map(|w| w.into_iter().skip(1));
    let parameters = theta[..2 * order].iter().copied().chain([held]).chain(levels);
    Ok(DVector::from_vec(parameters.collect()))
}
