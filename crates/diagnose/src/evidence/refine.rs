//! Each law at its own optimum: a few Gauss–Newton steps on shape and strength, the base's coordinates free to first order.

use super::context::{Context, Signal};
use nalgebra::{DMatrix, DVector};
use switchback_identify::record::Criterion;
use switchback_model::system::Term;

/// Steps, and halvings of each.
const STEPS: usize = 4;
const HALVINGS: usize = 4;

/// A law at its optimum.
#[derive(Debug, Clone)]
pub(super) struct Refined {
    pub(super) term: Term,
    /// Its change of the run.
    pub(super) change: Signal,
    /// Share of the energy of the filtered error that it takes.
    pub(super) share: f64,
}

/// Error and Jacobian of the base, filtered, as columns over all records.
pub(super) struct Filtered<'a> {
    context: &'a Context<'a>,
    criterion: &'a Criterion,
    runs: &'a Signal,
    /// Orthonormal basis of the base's Jacobian.
    basis: DMatrix<f64>,
    error: DVector<f64>,
}

fn joined(signal: &Signal) -> DVector<f64> {
    DVector::from_iterator(signal.iter().map(Vec::len).sum(), signal.iter().flatten().copied())
}

impl<'a> Filtered<'a> {
    /// `jacobian` and `error` filtered already.
    pub(super) fn new(
        context: &'a Context<'a>,
        (criterion, runs): (&'a Criterion, &'a Signal),
        jacobian: &[Signal],
        error: &Signal,
    ) -> Self {
        let error = joined(error);
        let columns: Vec<DVector<f64>> = jacobian.iter().map(joined).collect();
        let basis = orthonormal(&columns, error.len());
        let mut filtered = Self { context, criterion, runs, basis, error };
        filtered.error = filtered.freed(filtered.error.clone());
        filtered
    }

    fn freed(&self, mut x: DVector<f64>) -> DVector<f64> {
        if self.basis.ncols() > 0 {
            let c = self.basis.tr_mul(&x);
            x.gemv(-1.0, &self.basis, &c, 1.0);
        }
        x
    }

    /// The change by a term, filtered and freed of the base.
    fn column(&self, term: &Term) -> (Signal, DVector<f64>) {
        let change = self.context.change(self.runs, term);
        let filtered = self.context.filtered(std::slice::from_ref(&change), self.criterion);
        let column = self.freed(joined(&filtered[0]));
        (change, column)
    }

    /// The law from a start, the strength of which is chosen to first order.
    pub(super) fn refined(&self, start: &Term) -> Refined {
        let energy = self.error.norm_squared().max(f64::MIN_POSITIVE);
        let tried = |term: Term| {
            let (change, column) = self.column(&term);
            ((&self.error - &column).norm_squared(), term, change, column)
        };
        let first = tried(start.clone());
        let strength = first.3.dot(&self.error) / first.3.norm_squared().max(f64::MIN_POSITIVE);
        let scaled = tried(start.set(0, start.values[0] * strength));
        let (mut left, mut term, mut change, mut column) = if scaled.0 < first.0 { scaled } else { first };
        for _ in 0..STEPS {
            let Some(step) = self.step(&term, &column) else { break };
            let better = (0..HALVINGS).find_map(|k| {
                let factor = 0.5_f64.powi(k as i32);
                let next = moved(&term, &step, factor);
                if !next.law.is_sound(&next.values, &self.context.scale) {
                    return None;
                }
                let (change, column) = self.column(&next);
                let now = (&self.error - &column).norm_squared();
                (now < left).then_some((now, next, change, column))
            });
            let Some((now, next, changed, moved)) = better else { break };
            let gained = left - now;
            (left, term, change, column) = (now, next, changed, moved);
            if gained < 1e-3 * left {
                break;
            }
        }
        Refined { term, change, share: (1.0 - left / energy).max(0.0) }
    }

    /// The Gauss–Newton step of the free parameters.
    fn step(&self, term: &Term, column: &DVector<f64>) -> Option<Vec<(usize, f64)>> {
        let free: Vec<usize> = term.free().collect();
        let steps: Vec<f64> = free.iter().map(|k| term.step(*k, &self.context.scale)).collect();
        let derivatives: Vec<DVector<f64>> = free
            .iter()
            .zip(&steps)
            .map(|(k, step)| (self.column(&term.set(*k, term.values[*k] + step)).1 - column) / *step)
            .collect();
        let error = &self.error - column;
        let n = free.len();
        let mut h = DMatrix::from_fn(n, n, |i, j| derivatives[i].dot(&derivatives[j]));
        for i in 0..n {
            h[(i, i)] *= 1.0 + 1e-4;
            h[(i, i)] += f64::MIN_POSITIVE;
        }
        let g = DVector::from_fn(n, |i, _| derivatives[i].dot(&error));
        let step = h.cholesky()?.solve(&g);
        step.iter().all(|x| x.is_finite()).then(|| free.into_iter().zip(step.iter().copied()).collect())
    }
}

/// The term moved by a share of a step, at most by a factor of four in what is positive.
fn moved(term: &Term, step: &[(usize, f64)], factor: f64) -> Term {
    let mut out = term.clone();
    for (k, by) in step {
        let now = term.values[*k];
        let mut next = now + factor * by;
        if *k > 0 && now > 0.0 {
            next = next.clamp(0.25 * now, 4.0 * now);
        }
        out = out.set(*k, next);
    }
    out
}

/// Directions of the columns that are more than rounding, orthonormal.
fn orthonormal(columns: &[DVector<f64>], rows: usize) -> DMatrix<f64> {
    const LEAST: f64 = 1e-7;
    let n = columns.len();
    if n == 0 {
        return DMatrix::zeros(rows, 0);
    }
    let norms: Vec<f64> = columns.iter().map(|c| c.norm()).map(|n| if n > 0.0 { n } else { 1.0 }).collect();
    let scaled = DMatrix::from_columns(&columns.iter().zip(&norms).map(|(c, n)| c / *n).collect::<Vec<_>>());
    let eigen = (scaled.transpose() * &scaled).symmetric_eigen();
    let good: Vec<usize> = (0..n).filter(|k| eigen.eigenvalues[*k] > LEAST).collect();
    let rotation = DMatrix::from_fn(n, good.len(), |i, k| {
        eigen.eigenvectors[(i, good[k])] / eigen.eigenvalues[good[k]].sqrt()
    });
    scaled * rotation
}
