//! The slow obvious versions: literal regressors from the record, dense QR.

use nalgebra::{DMatrix, DVector};
use switchback_model::Record;
use switchback_model::hysteresis::Branch;

/// Least squares by QR on the full regressor matrix.
pub(crate) fn least_squares(rows: &[Vec<f64>], target: &[f64]) -> DVector<f64> {
    let matrix = DMatrix::from_fn(rows.len(), rows[0].len(), |i, j| rows[i][j]);
    let right = DVector::from_column_slice(target);
    let qr = matrix.qr();
    let projected = qr.q().transpose() * right;
    qr.r().solve_upper_triangular(&projected).expect("the columns are independent")
}

/// `a, b, F(V_j)` of one experiment exactly as the paper writes them: (3.14), (3.21), (3.24a–b), (3.25).
pub(crate) fn paper(
    record: &Record,
    branch: Branch,
    levels: &[f64],
    order: usize,
    first: usize,
    y0: f64,
) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let fold = |f: fn(f64, f64) -> f64| record.v().iter().copied().reduce(f).expect("not empty");
    let satellite = match branch {
        Branch::Descending => fold(f64::max),
        Branch::Ascending => fold(f64::min),
    };
    let w: Vec<f64> = levels.iter().map(|v| v - satellite).collect();
    let m = w.len();
    // ṽP_j(ṽ), P_j the Lagrange polynomial on the nodes 0, W_1…W_m with P_j(W_j) = 1 — evaluated at a node, 1 or 0.
    let basis = |v: f64, j: usize| if (v - satellite - w[j]).abs() < 1e-9 { w[j] } else { 0.0 };
    let mut rows = Vec::new();
    let mut target = Vec::new();
    for t in first..record.len() {
        let mut row: Vec<f64> = (1..=order).map(|i| -(record.y()[t - i] - y0)).collect();
        for i in 1..=order {
            row.extend((0..m).map(|j| basis(record.v()[t - i], j)));
        }
        rows.push(row);
        target.push(record.y()[t] - y0);
    }
    let theta = least_squares(&rows, &target);
    let mu = |i: usize, j: usize| theta[order + i * m + j];
    let c1 = match branch {
        Branch::Descending => -1.0 / w[0],
        Branch::Ascending => 1.0 / w[0],
    };
    let a: Vec<f64> = theta.iter().take(order).copied().collect();
    let b: Vec<f64> = (0..order).map(|i| mu(i, 0) / c1).collect();
    let norm: f64 = b.iter().map(|x| x * x).sum();
    let a1 = 1.0 + a.iter().sum::<f64>();
    let b1: f64 = b.iter().sum();
    let f = (0..m)
        .map(|j| (0..order).map(|i| b[i] * mu(i, j)).sum::<f64>() / norm * w[j] + a1 / b1 * y0)
        .collect();
    (a, b, f)
}

/// `a, b, F` of both experiments: literal columns for the lags, `w = u − u_m` where it is known, a free mean for every other (level, lag), and a constant.
pub(crate) fn joint(
    records: [(&Record, &[f64]); 2],
    order: usize,
    first: usize,
) -> (Vec<f64>, Vec<f64>, [Vec<f64>; 2]) {
    let inner: [usize; 2] = [records[0].1.len() - 1, records[1].1.len() - 1];
    let width = 2 * order + 1 + order * (inner[0] + inner[1]);
    let mut rows = Vec::new();
    let mut target = Vec::new();
    for (e, (record, levels)) in records.iter().enumerate() {
        let rest = if e == 0 { 1.0 } else { 0.0 };
        for t in first..record.len() {
            let mut row = vec![0.0; width];
            for i in 0..order {
                row[i] = -record.y()[t - 1 - i];
                match levels.iter().position(|l| (l - record.v()[t - 1 - i]).abs() < 1e-9) {
                    None => row[order + i] = rest,
                    Some(0) => row[order + i] = 1.0 - rest,
                    Some(j) => {
                        row[order + i] = rest;
                        row[2 * order + 1 + (e * inner[0] + j - 1) * order + i] = 1.0;
                    }
                }
            }
            row[2 * order] = 1.0;
            rows.push(row);
            target.push(record.y()[t]);
        }
    }
    let theta = least_squares(&rows, &target);
    let b: Vec<f64> = theta.rows(order, order).iter().copied().collect();
    let norm: f64 = b.iter().map(|x| x * x).sum();
    let u_low = theta[2 * order] / b.iter().sum::<f64>();
    let border = |e: usize| {
        let rest = if e == 0 { 1.0 } else { 0.0 };
        let mut f = vec![u_low + 1.0 - rest];
        f.extend((0..inner[e]).map(|j| {
            let h = theta.rows(2 * order + 1 + (e * inner[0] + j) * order, order);
            u_low + rest + h.iter().zip(&b).map(|(h, b)| h * b).sum::<f64>() / norm
        }));
        f
    };
    let (descending, ascending) = (border(0), border(1));
    (theta.rows(0, order).iter().copied().collect(), b, [descending, ascending])
}
