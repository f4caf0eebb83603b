//! The rank-one regression `μ = b fᵀ`, solved on the moments alone.

use super::equation_error::Moments;
use super::problem::Parameters;
use nalgebra::{DMatrix, DVector};

/// Moments of a smaller regression whose columns are combinations of the large one's; the output comes last.
type Reduced = DMatrix<f64>;

/// Moments of (y-lags, Σᵢ bᵢφₖ(t−i), 1, y): linear in `a, f, c` for given `b`.
fn for_curve(moments: &Moments, b: &[f64]) -> Reduced {
    combine(moments, moments.width, |j| {
        let (i, k) = (j / moments.width, j % moments.width);
        Some((k, b[i]))
    })
}

/// Moments of (y-lags, Σₖ f_kφₖ(t−i), 1, y): linear in `a, b, c` for given `f`.
fn for_numerator(moments: &Moments, f: &[f64]) -> Reduced {
    combine(moments, moments.structure.numerator(), |j| {
        let (i, k) = (j / moments.width, j % moments.width);
        Some((i, f[k]))
    })
}

/// `T M Tᵀ` for a `T` that sends product column `j` to `target(j)` and keeps the rest.
fn combine(moments: &Moments, width: usize, target: impl Fn(usize) -> Option<(usize, f64)>) -> Reduced {
    let n = moments.structure.order;
    let products = moments.structure.numerator() * moments.width;
    let size = n + width + 2;
    let map: Vec<(usize, f64)> = (0..moments.matrix.nrows())
        .map(|p| match p {
            p if p < n => (p, 1.0),
            p if p < n + products => target(p - n).map_or((0, 0.0), |(j, x)| (n + j, x)),
            p => (p - products + width, 1.0),
        })
        .collect();
    let mut reduced = DMatrix::zeros(size, size);
    for (q, &(j, x)) in map.iter().enumerate() {
        for (p, &(i, z)) in map.iter().enumerate() {
            reduced[(i, j)] += x * z * moments.matrix[(p, q)];
        }
    }
    reduced
}

/// Solves a regression given as moments (output last), with columns scaled to one and a ridge so small that it
/// only decides directions the data leave open.
pub(super) fn solve(moments: &Reduced, ridge: f64) -> Option<DVector<f64>> {
    let p = moments.nrows() - 1;
    let scale: Vec<f64> = (0..p).map(|i| moments[(i, i)].sqrt().max(f64::MIN_POSITIVE)).collect();
    let mut normal = DMatrix::from_fn(p, p, |i, j| moments[(i, j)] / (scale[i] * scale[j]));
    let right = DVector::from_fn(p, |i, _| moments[(i, p)] / scale[i]);
    for i in 0..p {
        normal[(i, i)] += ridge;
    }
    let mut x = normal.cholesky()?.solve(&right);
    for i in 0..p {
        x[i] /= scale[i];
    }
    Some(x)
}

/// Least-squares fit of `(a, b, f, c)` by alternation: `f` for given `b`, then `b` for given `f`; `a` and `c` both times.
pub(super) fn alternate(moments: &Moments, start: Vec<f64>, rounds: usize) -> Option<Parameters> {
    let (n, m) = (moments.structure.order, moments.width);
    let mut b = start;
    let mut result = None;
    for _ in 0..rounds {
        let x = solve(&for_curve(moments, &b), 1e-10)?;
        let f: Vec<f64> = x.as_slice()[n..n + m].to_vec();
        if f.iter().all(|&x| x == 0.0) {
            return None;
        }
        let x = solve(&for_numerator(moments, &f), 1e-10)?;
        let (a, rest) = x.as_slice().split_at(n);
        let (numerator, c) = rest.split_at(b.len());
        let fitted = Parameters { a: a.to_vec(), b: numerator.to_vec(), f, c: c[0] }.balanced();
        b = fitted.b.clone();
        result = Some(fitted);
    }
    result
}
