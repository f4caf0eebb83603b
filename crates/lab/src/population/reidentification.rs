//! What identification anew would take of a change of the output, to first order.
//!
//! The nominal system's free run is linear in what little its parameters change, so that identification anew is a projection: the
//! derivatives of the free run by `a`, `b` and the borders' values at knots, least squares over the fit records, the remainder over the held-out ones.

use super::setup::Setup;
use crate::generate::effects::motion::directions;
use crate::generate::machine::Machine;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use switchback_model::rig::Usage;

/// Knots of each border.
const KNOTS: usize = 15;
/// Rows used of the fit records, and of the others, at most.
const ROWS: usize = 3000;
/// Ridge over the mean square of each column.
const RIDGE: f64 = 1e-9;

/// The projection, laid out once for a setup.
pub(super) struct Reidentification {
    fitted: Rows,
    judged: Rows,
    factor: Cholesky<f64, Dyn>,
}

/// Derivatives at some samples.
struct Rows {
    /// Record and sample of each row.
    at: Vec<(usize, usize)>,
    /// A row a sample.
    derivatives: DMatrix<f64>,
}

impl Rows {
    fn new(columns: &[Vec<Vec<f64>>], is_used: impl Fn(usize) -> bool) -> Self {
        let all: Vec<(usize, usize)> = (0..columns.len())
            .filter(|record| is_used(*record))
            .flat_map(|record| (0..columns[record][0].len()).map(move |t| (record, t)))
            .collect();
        let stride = all.len().div_ceil(ROWS).max(1);
        let at: Vec<(usize, usize)> = all.into_iter().step_by(stride).collect();
        let width = columns[0].len();
        let derivatives =
            DMatrix::from_fn(at.len(), width, |row, column| columns[at[row].0][column][at[row].1]);
        Self { at, derivatives }
    }

    fn of(&self, signals: &[Vec<f64>]) -> DVector<f64> {
        DVector::from_iterator(self.at.len(), self.at.iter().map(|(record, t)| signals[*record][*t]))
    }
}

impl Reidentification {
    /// None where the derivatives are not finite.
    pub(super) fn new(setup: &Setup) -> Option<Self> {
        let columns: Vec<Vec<Vec<f64>>> = setup
            .runs
            .iter()
            .map(|run| {
                let all = derivatives(&setup.machine, setup.order, &run.passage.v);
                all.iter().map(|column| run.passage.recorded(column).to_vec()).collect()
            })
            .collect();
        let usage = |record: usize| setup.runs[record].passage.usage;
        let is_judged = |record: usize| usage(record) == Usage::Holdout;
        let any = (0..columns.len()).any(is_judged);
        let fitted = Rows::new(&columns, |record| usage(record) == Usage::Fit);
        let judged = Rows::new(&columns, |record| is_judged(record) || !any);
        let mut gram = fitted.derivatives.tr_mul(&fitted.derivatives);
        for i in 0..gram.nrows() {
            gram[(i, i)] += RIDGE * gram[(i, i)] + 1e-12 * gram.diagonal().max() + f64::MIN_POSITIVE;
        }
        Some(Self { fitted, judged, factor: Cholesky::new(gram)? })
    }

    /// The change of the parameters that a change of the output on the fit records brings.
    pub(super) fn parameters(&self, change: &[Vec<f64>]) -> DVector<f64> {
        self.factor.solve(&self.fitted.derivatives.tr_mul(&self.fitted.of(change)))
    }

    /// Root mean square of what is left on the held-out records.
    pub(super) fn left(&self, change: &[Vec<f64>]) -> f64 {
        let left = self.judged.of(change) - &self.judged.derivatives * self.parameters(change);
        (left.norm_squared() / left.len().max(1) as f64).sqrt()
    }
}

/// The free run's derivatives over a passage: by the borders' values at knots, by `a`, by `b`.
pub(super) fn derivatives(machine: &Machine, order: usize, v: &[f64]) -> Vec<Vec<f64>> {
    let (a, b) = (&machine.a[..], &machine.b[..]);
    let u = machine.hysteresis.output(v, machine.hysteresis.u_low());
    let behind = |numerator: &[f64], signal: &[f64]| filter(numerator, a, signal);
    let y = behind(b, &u);
    let mut columns = Vec::new();
    let directions = directions(machine, v);
    for side in [-1.0, 1.0] {
        for knot in 0..KNOTS {
            let hat = |(v, direction): (&f64, &f64)| {
                let place = (KNOTS - 1) as f64 * (v - machine.interval.low()) / machine.interval.width();
                let place = place.clamp(0.0, (KNOTS - 1) as f64);
                if *direction == side { (1.0 - (place - knot as f64).abs()).max(0.0) } else { 0.0 }
            };
            let hats: Vec<f64> = v.iter().zip(&directions).map(hat).collect();
            columns.push(behind(b, &hats));
        }
    }
    let one = behind(&[1.0], &y);
    let through = behind(&[1.0], &u);
    for lag in 0..order {
        columns.push(one.iter().map(|x| -x).collect::<Vec<f64>>());
        shift(columns.last_mut().expect("just added"), lag);
    }
    for lag in 0..=order {
        columns.push(through.clone());
        shift(columns.last_mut().expect("just added"), lag);
    }
    columns
}

/// `Σ bᵢ x(t−i) − Σ aᵢ y(t−i)`, at rest at the first value.
pub(super) fn filter(b: &[f64], a: &[f64], x: &[f64]) -> Vec<f64> {
    let rest = x[0] * b.iter().sum::<f64>() / (1.0 + a.iter().sum::<f64>());
    let mut y: Vec<f64> = Vec::with_capacity(x.len());
    for t in 0..x.len() {
        let mut now = 0.0;
        for (i, b) in b.iter().enumerate() {
            now += b * x[t.saturating_sub(i + 1)];
        }
        for (i, a) in a.iter().enumerate() {
            now -= a * if t > i { y[t - 1 - i] } else { rest };
        }
        y.push(now);
    }
    y
}

fn shift(x: &mut Vec<f64>, lag: usize) {
    let first = x[0];
    x.splice(0..0, std::iter::repeat_n(first, lag));
    x.truncate(x.len() - lag);
}
