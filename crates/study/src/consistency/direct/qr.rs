//! Dense least squares by Householder QR, a block of rows at a time.

use nalgebra::{DMatrix, DVector};

/// Rows that are taken in at once.
const BLOCK: usize = 512;

/// A diagonal entry of `R` below this share of its column's norm leaves no digits of the column: the arrow solver's measure.
const SINGULAR: f64 = 1e-7;

/// The triangle `R` of all rows so far, each row `φ₁…φ_p` followed by its targets.
#[derive(Debug)]
pub(super) struct Triangle {
    columns: usize,
    targets: usize,
    rows: Vec<f64>,
    r: DMatrix<f64>,
    count: usize,
}

/// Least squares of one target.
#[derive(Debug)]
pub(super) struct LeastSquares {
    pub(super) solution: DVector<f64>,
    /// `Σ r²`
    pub(super) residual: f64,
    /// Rows less columns, at least 1.
    pub(super) freedom: f64,
}

impl Triangle {
    pub(super) fn new(columns: usize, targets: usize) -> Self {
        let width = columns + targets;
        Self { columns, targets, rows: Vec::new(), r: DMatrix::zeros(0, width), count: 0 }
    }

    /// Adds a row with its targets.
    pub(super) fn push(&mut self, row: &[f64]) {
        self.rows.extend(row);
        self.count += 1;
        if self.rows.len() >= BLOCK * row.len() {
            self.reduce();
        }
    }

    /// Folds the rows that wait into the triangle.
    pub(super) fn reduce(&mut self) {
        let width = self.columns + self.targets;
        let (old, new) = (self.r.nrows(), self.rows.len() / width);
        let mut stacked = DMatrix::zeros(old + new, width);
        stacked.rows_mut(0, old).copy_from(&self.r);
        for (i, row) in self.rows.chunks_exact(width).enumerate() {
            stacked.row_mut(old + i).iter_mut().zip(row).for_each(|(into, x)| *into = *x);
        }
        self.r = stacked.qr().unpack_r();
        self.rows.clear();
    }

    /// The solution for target number `target`; `None` if the columns do not determine it. Call [`Self::reduce`] before.
    pub(super) fn solve(&self, target: usize) -> Option<LeastSquares> {
        let p = self.columns;
        if self.r.nrows() < p {
            return None;
        }
        let square = self.r.view((0, 0), (p, p));
        let sound = (0..p).all(|i| square[(i, i)].abs() > SINGULAR * square.column(i).norm());
        let right = self.r.view((0, p + target), (p, 1)).column(0).into_owned();
        let solution = if sound { square.solve_upper_triangular(&right)? } else { return None };
        let below = self.r.view((p, p + target), (self.r.nrows() - p, 1));
        let freedom = (self.count as f64 - p as f64).max(1.0);
        Some(LeastSquares { solution, residual: below.norm_squared(), freedom })
    }

    /// `‖R⁻ᵀg‖² = gᵀ(ΦᵀΦ)⁻¹g`.
    pub(super) fn quadratic(&self, gradient: &DVector<f64>) -> Option<f64> {
        let square = self.r.view((0, 0), (self.columns, self.columns));
        square.tr_solve_upper_triangular(gradient).map(|x| x.norm_squared())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_give_the_least_squares_of_all_rows() {
        let value =
            |i: usize, j: usize| ((1 + i * (j + 3)) as f64 * 0.7).sin() + if j == 0 { 1.0 } else { 0.0 };
        let rows = 2 * BLOCK + 77;
        let mut triangle = Triangle::new(3, 1);
        (0..rows).for_each(|i| triangle.push(&[value(i, 0), value(i, 1), value(i, 2), value(i, 5)]));
        triangle.reduce();
        let phi = DMatrix::from_fn(rows, 3, value);
        let target = DVector::from_fn(rows, |i, _| value(i, 5));
        let normal = phi.transpose() * &phi;
        let inverse = normal.try_inverse().expect("independent columns");
        let slow = &inverse * phi.transpose() * &target;
        let fast = triangle.solve(0).expect("independent columns");
        assert!((&fast.solution - &slow).amax() < 1e-12);
        assert!((fast.residual - (&phi * slow - target).norm_squared()).abs() < 1e-9);
        let gradient = DVector::from_vec(vec![1.0, -2.0, 0.5]);
        let quadratic = triangle.quadratic(&gradient).expect("independent columns");
        assert!((quadratic - gradient.dot(&(inverse * &gradient))).abs() < 1e-12);
    }

    #[test]
    fn columns_that_repeat_each_other_are_refused() {
        let mut triangle = Triangle::new(2, 1);
        (0..50).for_each(|i| triangle.push(&[f64::from(i), 3.0 * f64::from(i), 1.0]));
        triangle.reduce();
        assert!(triangle.solve(0).is_none());
    }
}
