//! Sums over earlier columns of a matrix, many rows at once.

use super::wide::{Work, widest};
use nalgebra::{Const, DMatrixView, Dyn};

/// Rows that are computed beside each other.
pub(super) const ABREAST: usize = 8;

/// A matrix of consecutive samples, a column each, its rows filled up to a multiple of [`ABREAST`].
#[derive(Debug, Clone)]
pub struct Columns {
    values: Vec<f64>,
    rows: usize,
    stride: usize,
}

impl Columns {
    /// So many rows and columns of zeros.
    pub fn zeros(rows: usize, columns: usize) -> Self {
        let stride = rows.next_multiple_of(ABREAST);
        Self { values: vec![0.0; stride * columns], rows, stride }
    }

    /// Number of rows.
    pub(super) fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns.
    pub(super) fn count(&self) -> usize {
        self.values.len() / self.stride.max(1)
    }

    /// Columns from one on, one after the other and filled up.
    pub(super) fn values_from(&self, first: usize) -> &[f64] {
        &self.values[self.stride * first..]
    }

    /// One column.
    pub fn column_mut(&mut self, k: usize) -> &mut [f64] {
        &mut self.values[self.stride * k..][..self.rows]
    }

    /// Consecutive columns.
    pub fn view(&self, first: usize, count: usize) -> DMatrixView<'_, f64> {
        let values = &self.values[self.stride * first..self.stride * (first + count)];
        let (shape, strides) = ((Dyn(self.rows), Dyn(count)), (Const::<1>, Dyn(self.stride)));
        DMatrixView::from_slice_with_strides_generic(values, shape.0, shape.1, strides.0, strides.1)
    }

    /// Moves columns from a place on to the first ones.
    pub fn carry_over(&mut self, from: usize, count: usize) {
        self.values.copy_within(self.stride * from..self.stride * (from + count), 0);
    }
}

/// `Σᵢ cᵢ x(t − i)`, `i` from 1, at some columns `t` of a matrix.
#[derive(Debug, Clone, Copy)]
pub struct Lagged<'a> {
    /// `c`, of lag 1 first.
    pub coefficients: &'a [f64],
    /// The first column at which the sum is taken; so many columns as there are coefficients lie before it.
    pub first: usize,
    /// Number of such columns.
    pub count: usize,
}

impl Lagged<'_> {
    /// `x(t) ← x(t) + Σᵢ cᵢ x(t − i)`, one column after the other.
    pub fn recurse(self, x: &mut Columns) {
        widest(Recursion { lagged: self, x });
    }

    /// `z(k) ← x(t) + Σᵢ cᵢ x(t − i)` with `k` counted from the first `t`.
    pub fn filter(self, x: &Columns, z: &mut Columns) {
        widest(Filter { lagged: self, x, z });
    }
}

struct Recursion<'a, 'b> {
    lagged: Lagged<'a>,
    x: &'b mut Columns,
}

impl Work for Recursion<'_, '_> {
    #[inline(always)]
    fn run(self) {
        let Self { lagged: Lagged { coefficients, first, count }, x: Columns { values, stride, .. } } = self;
        for t in first..first + count {
            let (past, now) = values.split_at_mut(*stride * t);
            sum(coefficients, past, &mut now[..*stride]);
        }
    }
}

struct Filter<'a, 'b> {
    lagged: Lagged<'a>,
    x: &'b Columns,
    z: &'b mut Columns,
}

impl Work for Filter<'_, '_> {
    #[inline(always)]
    fn run(self) {
        let Self { lagged: Lagged { coefficients, first, count }, x, z } = self;
        let stride = x.stride;
        for k in 0..count {
            let (past, now) = x.values.split_at(stride * (first + k));
            let z = &mut z.values[stride * k..][..stride];
            z.copy_from_slice(&now[..stride]);
            sum(coefficients, past, z);
        }
    }
}

/// Adds the sum over the columns that end with `past`, the last first.
#[inline(always)]
fn sum(coefficients: &[f64], past: &[f64], now: &mut [f64]) {
    let stride = now.len();
    let past = &past[past.len() - stride * coefficients.len()..];
    let (pieces, _) = now.as_chunks_mut::<ABREAST>();
    for (k, piece) in pieces.iter_mut().enumerate() {
        let mut sums = *piece;
        for (c, column) in coefficients.iter().zip(past.rchunks_exact(stride)) {
            let (earlier, _) = column.as_chunks::<ABREAST>();
            for (sum, x) in sums.iter_mut().zip(&earlier[k]) {
                *sum += c * x;
            }
        }
        *piece = sums;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A matrix with some values.
    fn columns(rows: usize, count: usize) -> Columns {
        let mut all = Columns::zeros(rows, count);
        for k in 0..count {
            all.column_mut(k)
                .iter_mut()
                .enumerate()
                .for_each(|(i, x)| *x = (1.7 * i as f64 + 0.9 * k as f64).rem_euclid(2.0) - 1.0);
        }
        all
    }

    /// The sum as it is written, for one row.
    fn slow(c: &[f64], x: &[f64], t: usize) -> f64 {
        c.iter().enumerate().fold(x[t], |sum, (i, c)| sum + c * x[t - 1 - i])
    }

    #[test]
    fn sums_are_those_of_every_row_by_itself() {
        for (rows, lags) in [(1, 1), (7, 2), (8, 3), (23, 6), (40, 12), (5, 0)] {
            let c: Vec<f64> = (0..lags).map(|i| 0.4 / f64::from(i + 1)).collect();
            let (first, count) = (lags as usize + 2, 9);
            let x = columns(rows, first + count);
            let lagged = Lagged { coefficients: &c, first, count };
            let (mut z, mut y) = (Columns::zeros(rows, count), x.clone());
            lagged.filter(&x, &mut z);
            lagged.recurse(&mut y);
            let (view, mut before) = (x.view(0, first + count), columns(rows, first + count));
            assert_eq!((view.nrows(), view.ncols()), (rows, first + count));
            for row in 0..rows {
                let mut own: Vec<f64> = view.row(row).iter().copied().collect();
                for t in first..first + count {
                    assert_eq!(z.view(0, count)[(row, t - first)], slow(&c, &own, t));
                }
                for t in first..first + count {
                    own[t] = slow(&c, &own, t);
                    assert_eq!(y.view(0, first + count)[(row, t)], own[t]);
                }
            }
            before.carry_over(3, 2);
            assert_eq!(before.view(0, 2), x.view(3, 2));
        }
    }
}
