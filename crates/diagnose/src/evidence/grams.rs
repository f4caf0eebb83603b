//! Inner products of signals by blocks, freed of the directions of the base.

use super::context::{Block, Signal};
use nalgebra::{DMatrix, DVector};

/// Eigenvalue of the scaled Gram matrix of the base below which a direction is none that the records show.
const LEAST_EIGENVALUE: f64 = 1e-7;

/// Gram matrices `ZᵀZ` by blocks: signal 0 the error, then candidates' columns, all freed of the base's Jacobian and scaled to unit norm but for the error.
#[derive(Debug, Clone)]
pub(super) struct Grams {
    pub(super) blocks: Vec<DMatrix<f64>>,
    pub(super) is_fitted: Vec<bool>,
    /// Their sum.
    pub(super) total: DMatrix<f64>,
    /// Norm of each signal that the base leaves, over its norm before.
    pub(super) kept: Vec<f64>,
    /// Coefficients of the error on the Jacobian.
    pub(super) absorbed: DVector<f64>,
}

fn stacked(signals: &[Signal], block: Block) -> DMatrix<f64> {
    let Block { record, from, to, .. } = block;
    DMatrix::from_fn(to - from, signals.len(), |t, k| signals[k][record][from + t])
}

impl Grams {
    /// Of the error and the candidates' columns, freed of the base's.
    pub(super) fn new(base: &[Signal], signals: &[Signal], blocks: &[Block]) -> Self {
        let (p, q) = (base.len(), signals.len());
        let parts: Vec<[DMatrix<f64>; 3]> = blocks
            .iter()
            .map(|block| {
                let (j, z) = (stacked(base, *block), stacked(signals, *block));
                // Products of matrices as such: `tr_mul` goes column by column.
                let transposed = j.transpose();
                [&transposed * &j, transposed * &z, z.transpose() * &z]
            })
            .collect();
        let sum = |k: usize, rows: usize, columns: usize| {
            parts.iter().fold(DMatrix::zeros(rows, columns), |sum, part| sum + &part[k])
        };
        let (jj, jz, zz) = (sum(0, p, p), sum(1, p, q), sum(2, q, q));
        let coefficients = solved(&jj, &jz);
        let transposed = coefficients.transpose();
        let free = |[jj, jz, zz]: &[DMatrix<f64>; 3]| {
            let cross = &transposed * jz;
            zz - &cross - cross.transpose() + &transposed * (jj * &coefficients)
        };
        let mut freed: Vec<DMatrix<f64>> = parts.iter().map(free).collect();
        let total = freed.iter().fold(DMatrix::zeros(q, q), |sum, part| sum + part);
        let norm = |m: &DMatrix<f64>, k: usize| m[(k, k)].max(0.0).sqrt();
        let kept: Vec<f64> =
            (0..q).map(|k| (norm(&total, k) / norm(&zz, k).max(f64::MIN_POSITIVE)).min(1.0)).collect();
        // What rounding leaves of a column that the base makes as well is none.
        let scale = |k: usize| match k {
            0 => 1.0,
            _ if kept[k].is_nan() || kept[k] < LEAST_KEPT => 0.0,
            _ => 1.0 / norm(&total, k),
        };
        let scales = DVector::from_fn(q, |k, _| scale(k));
        let scaled = |m: &DMatrix<f64>| DMatrix::from_fn(q, q, |i, j| m[(i, j)] * scales[i] * scales[j]);
        freed.iter_mut().for_each(|m| *m = scaled(m));
        Self {
            is_fitted: blocks.iter().map(|b| b.is_fitted).collect(),
            total: scaled(&total),
            blocks: freed,
            kept,
            absorbed: coefficients.column(0).into_owned(),
        }
    }

    /// Inner product of the error and a column: its sign is that of the column's coefficient.
    pub(super) fn along(&self, column: usize) -> f64 {
        self.total[(0, column)]
    }

    /// Energy of the error.
    pub(super) fn energy(&self) -> f64 {
        self.total[(0, 0)].max(f64::MIN_POSITIVE)
    }
}

/// Share of a column's norm that must be its own.
const LEAST_KEPT: f64 = 1e-4;

/// `H⁺X` over the directions that the records show.
fn solved(h: &DMatrix<f64>, x: &DMatrix<f64>) -> DMatrix<f64> {
    let n = h.nrows();
    if n == 0 {
        return DMatrix::zeros(0, x.ncols());
    }
    // A direction that no record shows has no size.
    let size = DVector::from_fn(n, |i, _| if h[(i, i)] > 0.0 { h[(i, i)].sqrt() } else { 1.0 });
    let eigen = DMatrix::from_fn(n, n, |i, j| h[(i, j)] / (size[i] * size[j])).symmetric_eigen();
    let scaled = DMatrix::from_fn(n, x.ncols(), |i, j| x[(i, j)] / size[i]);
    let mut coordinates = eigen.eigenvectors.tr_mul(&scaled);
    for (k, value) in eigen.eigenvalues.iter().enumerate() {
        let factor = if *value > LEAST_EIGENVALUE { 1.0 / value } else { 0.0 };
        coordinates.row_mut(k).scale_mut(factor);
    }
    let mut out = eigen.eigenvectors * coordinates;
    for i in 0..n {
        out.row_mut(i).scale_mut(1.0 / size[i]);
    }
    out
}
