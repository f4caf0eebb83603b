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

/// Solves a regression given as moments (output last).
fn solve(moments: &Reduced, ridge: f64) -> Option<DVector<f64>> {
    let p = moments.nrows() - 1;
    let right = DVector::from_fn(p, |i, _| moments[(i, p)]);
    solve_symmetric(&moments.view((0, 0), (p, p)).into(), &right, ridge)
}

/// Solves `(M + ridge·diag M) x = r` with columns scaled to one; a tiny ridge decides only what `M` leaves open.
pub(super) fn solve_symmetric(
    matrix: &DMatrix<f64>,
    right: &DVector<f64>,
    ridge: f64,
) -> Option<DVector<f64>> {
    let p = matrix.nrows();
    let scale = DVector::from_fn(p, |i, _| matrix[(i, i)].sqrt().max(f64::MIN_POSITIVE));
    let mut scaled = DMatrix::from_fn(p, p, |i, j| matrix[(i, j)] / (scale[i] * scale[j]));
    for i in 0..p {
        scaled[(i, i)] += ridge;
    }
    let x = scaled.cholesky()?.solve(&right.component_div(&scale));
    Some(x.component_div(&scale))
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

/// Coefficients of the over-parameterised regression itself, in its own order: unbiased and blind to the rank.
///
/// `None` if the records do not excite every column.
pub(super) fn over_parameterised(moments: &Moments) -> Option<DVector<f64>> {
    solve(&moments.matrix, 0.0)
}

/// Least-squares fit of `(a, b, f, c)` to the end: from a start, Gauss–Newton steps, halved while they do not help.
///
/// Under white equation error this is the maximum-likelihood estimate, so it is consistent and attains the Cramér–Rao bound of
/// the rank-one regression; the first step from the over-parameterised estimate already does, to first order.
pub(super) fn gauss_newton(moments: &Moments, start: Parameters) -> Parameters {
    let mut theta = start.balanced();
    let mut energy = residual_energy(moments, &theta);
    let p = moments.constant() + 1;
    // Near an exact fit the energy is lost in rounding, while the step still improves the parameters.
    let rounding = 1e-12 * moments.matrix[(p, p)];
    for _ in 0..MOST_STEPS {
        let Some(step) = solve_symmetric(&information(moments, &theta), &score(moments, &theta), 1e-13)
        else {
            break;
        };
        let shares = (0..12).map(|k| 0.5f64.powi(k));
        let better = shares.map(|share| theta.moved((&step * share).as_slice())).find_map(|next| {
            let next_energy = residual_energy(moments, &next);
            (next_energy <= energy + rounding).then_some((next, next_energy))
        });
        let Some((next, next_energy)) = better else { break };
        let size = products(moments, &theta);
        let change = (products(moments, &next) - &size).norm() / size.norm();
        (theta, energy) = (next.balanced(), next_energy);
        if change < 1e-14 {
            break;
        }
    }
    theta
}

/// Gauss–Newton converges in a handful of steps; this only bounds a crawl along a flat valley.
const MOST_STEPS: usize = 30;

/// `b` and `f` of unit size that come nearest to a matrix of their products: its leading singular vectors.
pub(super) fn nearest_rank_one(moments: &Moments, coefficients: &DVector<f64>) -> Option<Parameters> {
    let (n, nb, m) = (moments.structure.order, moments.structure.numerator(), moments.width);
    let products = DMatrix::from_fn(nb, m, |i, k| coefficients[moments.product(i, k)]);
    let svd = products.svd(true, true);
    let (u, vt) = (svd.u?, svd.v_t?);
    let leading = svd.singular_values.imax();
    let b = u.column(leading) * svd.singular_values[leading];
    let f = vt.row(leading);
    Some(Parameters {
        a: coefficients.as_slice()[..n].to_vec(),
        b: b.iter().copied().collect(),
        f: f.iter().copied().collect(),
        c: coefficients[moments.constant()],
    })
}

/// Where `(a, b, f, c)` lies in the over-parameterised regression: `a`, every `bᵢf_k`, `c`.
fn products(moments: &Moments, theta: &Parameters) -> DVector<f64> {
    let values = theta.b.iter().flat_map(|b| theta.f.iter().map(move |f| b * f));
    let all = theta.a.iter().copied().chain(values).chain([theta.c]);
    DVector::from_iterator(moments.constant() + 1, all)
}

/// Sum of squared equation errors.
pub(super) fn residual_energy(moments: &Moments, theta: &Parameters) -> f64 {
    let x = products(moments, theta).push(-1.0);
    x.dot(&(&moments.matrix * &x)).max(0.0)
}

/// `Jᵀ Σ Φξ`: half the downhill gradient of the squared equation errors with respect to `(a, b, f, c)`.
pub(super) fn score(moments: &Moments, theta: &Parameters) -> DVector<f64> {
    let p = moments.constant() + 1;
    let output: DVector<f64> = moments.matrix.view((0, p), (p, 1)).column(0).into();
    let residual = output - moments.matrix.view((0, 0), (p, p)) * products(moments, theta);
    jacobian(moments, theta).tr_mul(&residual)
}

/// `JᵀMJ`, with `J` the derivative of the over-parameterised coefficients with respect to `(a, b, f, c)`: the
/// information of the rank-one regression per unit noise variance.
pub(super) fn information(moments: &Moments, theta: &Parameters) -> DMatrix<f64> {
    let jacobian = jacobian(moments, theta);
    let p = jacobian.nrows();
    jacobian.transpose() * moments.matrix.view((0, 0), (p, p)) * jacobian
}

/// Derivative of [`products`].
fn jacobian(moments: &Moments, theta: &Parameters) -> DMatrix<f64> {
    let (n, nb, m) = (theta.a.len(), theta.b.len(), theta.f.len());
    let mut jacobian = DMatrix::zeros(moments.constant() + 1, n + nb + m + 1);
    for i in 0..n {
        jacobian[(i, i)] = 1.0;
    }
    for i in 0..nb {
        for k in 0..m {
            jacobian[(moments.product(i, k), n + i)] = theta.f[k];
            jacobian[(moments.product(i, k), n + nb + k)] = theta.b[i];
        }
    }
    jacobian[(moments.constant(), n + nb + m)] = 1.0;
    jacobian
}
