//! The best nominal model of a rig: what it leaves is the surviving gap.

use crate::generate::dataset::Passage;
use crate::generate::machine::Machine;
use nalgebra::{Cholesky, DMatrix, DVector};
use switchback_model::rig::Usage;

/// The nominal structure as a linear regression, laid out once for a dataset and solved for any outputs.
///
/// ```text
/// y(t) = −Σᵢ aᵢ y(t−i) + Σᵢ Σ_k μ_ik φ_k(t−i) + ξ(t),   i = 1…n
/// ```
///
/// with a hat function `φ_k` at every level for each of the two borders, and several between two levels where the borders are curved.
/// The `μ_ik` are left free (not of rank one), so the nominal model can absorb no more than this.
pub(crate) struct Refit {
    order: usize,
    columns: usize,
    /// For each passage the active columns at each of its samples; empty where the branch is not known yet.
    hats: Vec<Vec<[(usize, f64); 2]>>,
    /// First sample of each passage that is predicted.
    first: Vec<usize>,
}

/// Cells of a curved border's table to a cell between levels: what a table of straight pieces misses falls with the square.
const FINER: usize = 4;

/// What the best nominal re-fit leaves.
pub(crate) struct Leftover {
    /// One-step residuals of every passage over its record; zero before the first predicted sample.
    pub residuals: Vec<Vec<f64>>,
    /// First predicted sample of each record.
    pub first: Vec<usize>,
    /// Residual variance over the fit records, degrees of freedom allowed for.
    pub variance: f64,
}

impl Refit {
    /// Lays out the regression for the commanded inputs of a dataset.
    pub(crate) fn new(machine: &Machine, passages: &[Passage]) -> Self {
        let order = machine.order();
        let knots = 1 + (machine.levels.len() - 1) * if machine.curved { FINER } else { 1 };
        let mut hats = Vec::with_capacity(passages.len());
        let mut first = Vec::with_capacity(passages.len());
        for passage in passages {
            let v = passage.recorded(&passage.v);
            let moved = (1..v.len()).find(|&t| v[t] != v[t - 1]).unwrap_or(v.len());
            first.push((moved + order).min(v.len()));
            let mut rising = true;
            let row = |(t, &now): (usize, &f64)| {
                if t > 0 && now != v[t - 1] {
                    rising = now > v[t - 1];
                }
                let place = (knots - 1) as f64 * (now - machine.interval.low()) / machine.interval.width();
                let left = (place.max(0.0) as usize).min(knots - 2);
                let share = place - left as f64;
                let column = left + if rising { 0 } else { knots };
                [(column, 1.0 - share), (column + 1, share)]
            };
            hats.push(v.iter().enumerate().map(row).collect());
        }
        Self { order, columns: order + order * 2 * knots, hats, first }
    }

    /// Regressors of sample `t` of a record: column and value.
    fn regressors(&self, record: usize, y: &[f64], t: usize, into: &mut Vec<(usize, f64)>) {
        into.clear();
        let per_lag = (self.columns - self.order) / self.order;
        for i in 1..=self.order {
            into.push((i - 1, -y[t - i]));
            let base = self.order + (i - 1) * per_lag;
            into.extend(self.hats[record][t - i].iter().map(|&(column, value)| (base + column, value)));
        }
    }

    /// Least squares over the fit records, residuals over all.
    ///
    /// `outputs` holds the recorded output of each passage. Columns that nothing excites and the constants that lags
    /// share are settled by a ridge far below the noise.
    pub(crate) fn solve(&self, passages: &[Passage], outputs: &[Vec<f64>]) -> Leftover {
        let p = self.columns;
        let centre =
            outputs.iter().flatten().sum::<f64>() / outputs.iter().map(Vec::len).sum::<usize>() as f64;
        let centred: Vec<Vec<f64>> = outputs.iter().map(|y| y.iter().map(|y| y - centre).collect()).collect();
        let mut gram = DMatrix::<f64>::zeros(p, p);
        let mut cross = DVector::<f64>::zeros(p);
        let mut active = Vec::with_capacity(3 * self.order);
        let mut samples = 0_usize;
        for (record, y) in centred.iter().enumerate().filter(|(r, _)| passages[*r].usage == Usage::Fit) {
            for t in self.first[record]..y.len() {
                self.regressors(record, y, t, &mut active);
                for &(i, x) in &active {
                    cross[i] += x * y[t];
                    for &(j, z) in &active {
                        gram[(i, j)] += x * z;
                    }
                }
                samples += 1;
            }
        }
        let excited = (0..p).filter(|&i| gram[(i, i)] > 0.0).count();
        // Each lag's hats sum to one, so all lags but one repeat the constant.
        let rank = excited.saturating_sub(self.order - 1);
        for i in 0..p {
            gram[(i, i)] += 1e-9 * gram[(i, i)] + f64::MIN_POSITIVE.sqrt();
        }
        let theta = Cholesky::new(gram).map_or_else(|| DVector::zeros(p), |c| c.solve(&cross));
        let mut sum = 0.0;
        let mut residuals = Vec::with_capacity(centred.len());
        for (record, y) in centred.iter().enumerate() {
            let mut own = vec![0.0; y.len()];
            for t in self.first[record]..y.len() {
                self.regressors(record, y, t, &mut active);
                own[t] = y[t] - active.iter().map(|&(i, x)| x * theta[i]).sum::<f64>();
            }
            if passages[record].usage == Usage::Fit {
                sum += own.iter().map(|r| r * r).sum::<f64>();
            }
            residuals.push(own);
        }
        let variance = sum / samples.saturating_sub(rank).max(1) as f64;
        Leftover { residuals, first: self.first.clone(), variance }
    }
}
