//! Normal equations accumulated from sparse or dense rows, and their damped solution.

use nalgebra::{DMatrix, DVector};
use switchback_estimator::lanes::{Work, widest};

/// `Σ x xᵀ` (upper triangle) and `Σ x w` over rows `x` with right-hand sides `w`.
#[derive(Debug, Clone)]
pub(crate) struct Normal {
    pub(crate) size: usize,
    /// Row-major, upper triangle filled.
    matrix: Vec<f64>,
    pub(crate) gradient: Vec<f64>,
    /// Room for a row.
    terms: Vec<(u32, f64)>,
}

/// Dense rows on their way into normal equations.
struct DenseRows<'a> {
    normal: &'a mut Normal,
    rows: &'a [f64],
    columns: usize,
    w: &'a [f64],
}

/// Rows taken at a time: the matrix is read and written once for all of them.
const ABREAST: usize = 8;

impl Work for DenseRows<'_> {
    #[inline(always)]
    fn run(self) {
        let Self { normal, rows, columns, w } = self;
        let whole = w.len() / ABREAST * ABREAST;
        let (blocks, rest) = w.split_at(whole);
        let whole = whole * columns;
        for (rows, w) in rows[..whole].chunks_exact(ABREAST * columns).zip(blocks.chunks_exact(ABREAST)) {
            let (a, b) = rows.split_at(4 * columns);
            let ((r0, r1), (r2, r3)) = quarters(a, columns);
            let ((r4, r5), (r6, r7)) = quarters(b, columns);
            for i in 0..columns {
                let (x0, x1, x2, x3) = (r0[i], r1[i], r2[i], r3[i]);
                let (x4, x5, x6, x7) = (r4[i], r5[i], r6[i], r7[i]);
                normal.gradient[i] += ((x0 * w[0] + x1 * w[1]) + (x2 * w[2] + x3 * w[3]))
                    + ((x4 * w[4] + x5 * w[5]) + (x6 * w[6] + x7 * w[7]));
                let target = &mut normal.matrix[i * normal.size + i..i * normal.size + columns];
                let n = target.len();
                let (y0, y1, y2, y3) = (&r0[i..][..n], &r1[i..][..n], &r2[i..][..n], &r3[i..][..n]);
                let (y4, y5, y6, y7) = (&r4[i..][..n], &r5[i..][..n], &r6[i..][..n], &r7[i..][..n]);
                for j in 0..n {
                    target[j] += ((x0 * y0[j] + x1 * y1[j]) + (x2 * y2[j] + x3 * y3[j]))
                        + ((x4 * y4[j] + x5 * y5[j]) + (x6 * y6[j] + x7 * y7[j]));
                }
            }
        }
        for (row, w) in rows[whole..].chunks_exact(columns).zip(rest) {
            for i in 0..columns {
                normal.gradient[i] += row[i] * w;
                let target = &mut normal.matrix[i * normal.size + i..i * normal.size + columns];
                for (m, y) in target.iter_mut().zip(&row[i..]) {
                    *m += row[i] * y;
                }
            }
        }
    }
}

/// The rows of a block of four.
#[inline(always)]
#[expect(clippy::type_complexity, reason = "two pairs of rows")]
fn quarters(block: &[f64], columns: usize) -> ((&[f64], &[f64]), (&[f64], &[f64])) {
    let (first, second) = block.split_at(2 * columns);
    (first.split_at(columns), second.split_at(columns))
}

impl Normal {
    pub(crate) fn new(size: usize) -> Self {
        Self {
            size,
            matrix: vec![0.0; size * size],
            gradient: vec![0.0; size],
            terms: Vec::with_capacity(size),
        }
    }

    /// Adds one row, mostly zeros.
    pub(crate) fn add(&mut self, row: &[f64], w: f64) {
        let mut terms = std::mem::take(&mut self.terms);
        terms.clear();
        terms.extend(row.iter().enumerate().filter(|(_, x)| **x != 0.0).map(|(i, x)| (i as u32, *x)));
        self.add_sparse(&terms, w);
        self.terms = terms;
    }

    /// Adds one sparse row, its indices increasing.
    pub(crate) fn add_sparse(&mut self, row: &[(u32, f64)], w: f64) {
        for (k, &(i, x)) in row.iter().enumerate() {
            let i = i as usize;
            self.gradient[i] += x * w;
            let target = &mut self.matrix[i * self.size..(i + 1) * self.size];
            for &(j, y) in &row[k..] {
                target[j as usize] += x * y;
            }
        }
    }

    /// Adds dense rows of the first `columns` parameters, row-major.
    pub(crate) fn add_dense(&mut self, rows: &[f64], columns: usize, w: &[f64]) {
        widest(DenseRows { normal: self, rows, columns, w });
    }

    /// Adds `weight·(row·θ)²` given the present `θ`: a prior.
    pub(crate) fn add_prior(&mut self, terms: &[(usize, f64)], weight: f64, present: &[f64]) {
        let value: f64 = terms.iter().map(|&(i, c)| c * present[i]).sum();
        for &(i, c) in terms {
            self.gradient[i] += weight * c * value;
        }
        self.hold(terms, weight);
    }

    /// Keeps a step from moving along a direction.
    pub(crate) fn hold(&mut self, terms: &[(usize, f64)], weight: f64) {
        for &(i, c) in terms {
            for &(j, d) in terms {
                if j >= i {
                    self.matrix[i * self.size + j] += weight * c * d;
                }
            }
        }
    }

    /// Sets an entry of the symmetric matrix.
    pub(crate) fn set(&mut self, i: usize, j: usize, x: f64) {
        self.matrix[i.min(j) * self.size + i.max(j)] = x;
    }

    /// The equations with all but the chosen parameters held.
    pub(crate) fn restricted(&self, chosen: impl Fn(usize) -> bool) -> Self {
        let mut out = self.clone();
        for i in 0..self.size {
            for j in i..self.size {
                if !chosen(i) || !chosen(j) {
                    out.set(i, j, if i == j { 1.0 } else { 0.0 });
                }
            }
            if !chosen(i) {
                out.gradient[i] = 0.0;
            }
        }
        out
    }

    /// Entry of the symmetric matrix.
    pub(crate) fn entry(&self, i: usize, j: usize) -> f64 {
        self.matrix[i.min(j) * self.size + i.max(j)]
    }

    /// Cholesky factor of the matrix with relative damping of its diagonal; `None` if it is not positive definite.
    pub(crate) fn factor(&self, damping: f64) -> Option<Factor> {
        let n = self.size;
        let scale: Vec<f64> = (0..n)
            .map(|i| {
                let d = self.entry(i, i);
                if d > 0.0 { 1.0 / d.sqrt() } else { 1.0 }
            })
            .collect();
        let m = DMatrix::from_fn(n, n, |i, j| {
            let x = self.entry(i, j) * scale[i] * scale[j];
            if i == j { x + damping + 1e-12 } else { x }
        });
        Some(Factor { cholesky: m.cholesky()?, scale })
    }
}

/// A scaled Cholesky factor.
#[derive(Debug, Clone)]
pub(crate) struct Factor {
    cholesky: nalgebra::Cholesky<f64, nalgebra::Dyn>,
    scale: Vec<f64>,
}

impl Factor {
    /// Solves `M x = g`.
    pub(crate) fn solve(&self, g: &[f64]) -> Vec<f64> {
        let rhs = DVector::from_iterator(g.len(), g.iter().zip(&self.scale).map(|(x, s)| x * s));
        let x = self.cholesky.solve(&rhs);
        x.iter().zip(&self.scale).map(|(x, s)| x * s).collect()
    }

    /// Diagonal entry of `M⁻¹`.
    pub(crate) fn inverse_diagonal(&self, i: usize) -> f64 {
        let mut unit = vec![0.0; self.scale.len()];
        unit[i] = 1.0;
        self.solve(&unit)[i]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sparse_and_dense_rows_give_the_same_normal_equations() {
        let rows = [[1.0, 0.0, 0.0, 2.0, 0.0, 0.0], [0.5, 1.0, 3.0, -1.0, 0.2, 4.0]];
        let mut n = Normal::new(6);
        n.add(&rows[0], 1.0);
        n.add(&rows[1], -2.0);
        let mut dense = Normal::new(6);
        dense.add_dense(&rows.concat(), 6, &[1.0, -2.0]);
        assert_eq!((&n.matrix, &n.gradient), (&dense.matrix, &dense.gradient));
        // Four rows at a time and one at a time.
        let six: Vec<f64> = (0..36).map(|i| f64::from(i * i % 7)).collect();
        let w = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        let mut dense = Normal::new(6);
        dense.add_dense(&six, 6, &w);
        let mut sparse = Normal::new(6);
        six.chunks(6).zip(w).for_each(|(row, w)| sparse.add(row, w));
        assert_eq!((&dense.matrix, &dense.gradient), (&sparse.matrix, &sparse.gradient));
        for i in 0..6 {
            let g: f64 = rows[0][i] - 2.0 * rows[1][i];
            assert!((n.gradient[i] - g).abs() < 1e-15);
            for j in 0..6 {
                let m: f64 = rows.iter().map(|r| r[i] * r[j]).sum();
                assert!((n.entry(i, j) - m).abs() < 1e-15);
            }
        }
    }
}
