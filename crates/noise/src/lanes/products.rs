//! Sums of products of the rows of matrices.

use super::lagged::{ABREAST, Columns};
use super::wide::{Work, widest};
use nalgebra::DMatrix;

/// Rows of the second matrix that are multiplied beside each other.
const BESIDE: usize = 4;
/// Columns that stay in the cache while all their products are added.
const CHUNK: usize = 128;

/// `Σ_t w_t x(t) x(t)ᵀ` over columns `x(t)` of matrices of equally many rows: the bits are the same on every processor.
#[derive(Debug, Clone)]
pub struct Products {
    /// Columns of the lower triangle, and of what its blocks have above that.
    sums: Vec<f64>,
    rows: usize,
    stride: usize,
}

impl Products {
    /// Of matrices of so many rows, over no column.
    pub fn zeros(rows: usize) -> Self {
        let stride = rows.next_multiple_of(ABREAST);
        Self { sums: vec![0.0; stride * stride], rows, stride }
    }

    /// Adds the columns from a first one on, each with its weight.
    ///
    /// # Panics
    /// If the matrix has other rows, or fewer columns.
    pub fn add(&mut self, x: &Columns, first: usize, weights: &[f64]) {
        assert_eq!(x.rows(), self.rows, "rows");
        let from = |k: usize| x.values_from(first + CHUNK * k);
        for (k, weights) in weights.chunks(CHUNK).enumerate() {
            let x = Strided { values: from(k), stride: self.stride };
            widest(Sum { sums: &mut self.sums, x, z: x, weights, is_lower: true });
        }
    }

    /// The sums, a square matrix of as many rows.
    pub fn matrix(&self) -> DMatrix<f64> {
        let lower = |i: usize, j: usize| self.sums[self.stride * i.min(j) + i.max(j)];
        DMatrix::from_fn(self.rows, self.rows, lower)
    }

    /// `Σ_t x(t) z(t)ᵀ` over all columns of two matrices, a row for every row of `x`.
    ///
    /// # Panics
    /// If `z` has fewer columns than `x`.
    pub fn between(x: &Columns, z: &Columns) -> DMatrix<f64> {
        let [down, across] = [x, z].map(|m| m.rows().next_multiple_of(ABREAST));
        let mut sums = vec![0.0; down * across];
        let count = x.count();
        for first in (0..count).step_by(CHUNK) {
            let weights = &[1.0; CHUNK][..CHUNK.min(count - first)];
            let x = Strided { values: x.values_from(first), stride: down };
            let z = Strided { values: z.values_from(first), stride: across };
            widest(Sum { sums: &mut sums, x, z, weights, is_lower: false });
        }
        DMatrix::from_fn(x.rows(), z.rows(), |i, j| sums[down * j + i])
    }
}

/// Columns one after the other.
#[derive(Clone, Copy)]
struct Strided<'a> {
    values: &'a [f64],
    stride: usize,
}

struct Sum<'a> {
    sums: &'a mut [f64],
    x: Strided<'a>,
    z: Strided<'a>,
    /// One a column that counts.
    weights: &'a [f64],
    /// Whether blocks above the diagonal are left out.
    is_lower: bool,
}

impl Work for Sum<'_> {
    #[inline(always)]
    fn run(self) {
        let Self { sums, x, z, weights, is_lower } = self;
        for top in (0..x.stride).step_by(ABREAST) {
            let across = if is_lower { top + ABREAST } else { z.stride };
            for left in (0..across).step_by(BESIDE) {
                let mut block = [[0.0; ABREAST]; BESIDE];
                let columns = x.values.chunks_exact(x.stride).zip(z.values.chunks_exact(z.stride));
                for ((x, z), weight) in columns.zip(weights) {
                    let down: &[f64; ABREAST] = x[top..].first_chunk().expect("rows are filled up");
                    let across: &[f64; BESIDE] = z[left..].first_chunk().expect("rows are filled up");
                    for (sums, z) in block.iter_mut().zip(across) {
                        let z = weight * z;
                        for (sum, x) in sums.iter_mut().zip(down) {
                            *sum += x * z;
                        }
                    }
                }
                for (j, block) in block.iter().enumerate() {
                    let into = &mut sums[x.stride * (left + j) + top..][..ABREAST];
                    into.iter_mut().zip(block).for_each(|(sum, more)| *sum += more);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(rows: usize, count: usize, step: f64) -> Columns {
        let mut x = Columns::zeros(rows, count);
        for t in 0..count {
            let value = |i: usize| (1.3 * i as f64 + step * t as f64).rem_euclid(2.0) - 1.0;
            x.column_mut(t).iter_mut().enumerate().for_each(|(i, x)| *x = value(i));
        }
        x
    }

    #[test]
    fn sums_are_those_of_the_products_by_themselves() {
        for (rows, count) in [(1, 1), (3, 5), (8, 40), (9, 7), (24, 300), (37, 61)] {
            let x = matrix(rows, count + 2, 0.7);
            let weights: Vec<f64> = (0..count).map(|t| f64::from(t as u32 % 3) + 0.5).collect();
            let mut products = Products::zeros(rows);
            products.add(&x, 2, &weights);
            products.add(&x, 0, &[1.0]);
            let columns = (0..count).map(|t| (t + 2, weights[t])).chain([(0, 1.0)]);
            let mut slow = DMatrix::zeros(rows, rows);
            for (t, weight) in columns {
                let column = x.view(t, 1).clone_owned();
                slow += weight * &column * column.transpose();
            }
            assert!((products.matrix() - &slow).amax() <= 1e-13 * slow.amax(), "{rows} × {count}");
        }
    }

    #[test]
    fn sums_between_two_matrices_are_their_product() {
        for (rows, others, count) in [(1, 1, 1), (3, 9, 5), (30, 4, 300), (8, 8, 128)] {
            let (x, z) = (matrix(rows, count, 0.7), matrix(others, count, 1.1));
            let slow = x.view(0, count) * z.view(0, count).transpose();
            let fast = Products::between(&x, &z);
            assert!((fast - &slow).amax() <= 1e-12 * slow.amax(), "{rows} × {others}");
        }
    }
}
