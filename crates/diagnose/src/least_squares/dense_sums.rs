//! Normal equations of dense rows, summed up block by block.

use switchback_noise::lanes::{LANES, Work, keep_apart, widest};

use crate::least_squares::normal::Normal;

/// Rows taken at a time: the matrix is read and written once for all of them.
const ABREAST: usize = 8;
/// Rows kept before they are summed up: few enough to stay near the processor.
const BLOCK: usize = 64;

/// `Σ x xᵀ` and `Σ x w` over dense rows `x` whose entries belong to some of the parameters.
pub(crate) struct DenseSums {
    /// The parameters that the entries belong to, increasing.
    parameters: Vec<usize>,
    /// Entries from one row to the next: whole vectors.
    stride: usize,
    /// Row-major; below the diagonal nothing that counts.
    matrix: Vec<f64>,
    gradient: Vec<f64>,
    /// Rows not yet summed up, and their right-hand sides.
    rows: Vec<f64>,
    w: Vec<f64>,
}

impl DenseSums {
    pub(crate) fn new(parameters: Vec<usize>) -> Self {
        let stride = parameters.len().next_multiple_of(LANES);
        Self {
            parameters,
            stride,
            matrix: vec![0.0; stride * stride],
            gradient: vec![0.0; stride],
            rows: Vec::with_capacity(BLOCK * stride),
            w: Vec::with_capacity(BLOCK),
        }
    }

    /// Adds a row, then the entries of `further`, all in the order of the parameters, and the right-hand side.
    pub(crate) fn push(&mut self, row: &[f64], further: impl Iterator<Item = f64>, w: f64) {
        self.rows.extend_from_slice(row);
        self.rows.extend(further);
        self.w.push(w);
        self.rows.resize(self.w.len() * self.stride, 0.0);
        if self.w.len() == BLOCK {
            self.sum_up();
        }
    }

    fn sum_up(&mut self) {
        // Rows of zeros add nothing.
        let whole = self.w.len().next_multiple_of(ABREAST);
        self.w.resize(whole, 0.0);
        self.rows.resize(whole * self.stride, 0.0);
        widest(Block { sums: self });
        self.rows.clear();
        self.w.clear();
    }

    /// Adds the sums to normal equations of all parameters.
    pub(crate) fn add_to(mut self, normal: &mut Normal) {
        self.sum_up();
        normal.add_block(&self.parameters, &self.matrix, self.stride);
        for (&row, sum) in self.parameters.iter().zip(&self.gradient) {
            normal.gradient[row] += sum;
        }
    }
}

/// The rows kept, before they enter the sums.
struct Block<'a> {
    sums: &'a mut DenseSums,
}

impl Work for Block<'_> {
    #[inline(always)]
    fn run(self) {
        let DenseSums { parameters, stride, matrix, gradient, rows, w } = self.sums;
        let (stride, columns) = (*stride, parameters.len());
        for (rows, w) in rows.chunks_exact(ABREAST * stride).zip(w.chunks_exact(ABREAST)) {
            let (a, b) = rows.split_at(4 * stride);
            let ((r0, r1), (r2, r3)) = quarters(a, stride);
            let ((r4, r5), (r6, r7)) = quarters(b, stride);
            for i in 0..columns {
                let (x0, x1, x2, x3) = (r0[i], r1[i], r2[i], r3[i]);
                let (x4, x5, x6, x7) = (r4[i], r5[i], r6[i], r7[i]);
                gradient[i] += ((x0 * w[0] + x1 * w[1]) + (x2 * w[2] + x3 * w[3]))
                    + ((x4 * w[4] + x5 * w[5]) + (x6 * w[6] + x7 * w[7]));
                // From the vector that holds the diagonal: what of it lies below is not read.
                let from = i / LANES * LANES;
                let target = &mut matrix[i * stride + from..(i + 1) * stride];
                let y = [r0, r1, r2, r3, r4, r5, r6, r7].map(|row| row[from..].as_chunks::<LANES>().0);
                for (j, target) in target.as_chunks_mut::<LANES>().0.iter_mut().enumerate() {
                    keep_apart();
                    let low = plus(
                        plus(times(x0, y[0][j]), times(x1, y[1][j])),
                        plus(times(x2, y[2][j]), times(x3, y[3][j])),
                    );
                    let high = plus(
                        plus(times(x4, y[4][j]), times(x5, y[5][j])),
                        plus(times(x6, y[6][j]), times(x7, y[7][j])),
                    );
                    *target = plus(*target, plus(low, high));
                }
            }
        }
    }
}

/// Lanes by value: nothing is stored before all of them are read, so that they stay together in a vector.
#[inline(always)]
pub(crate) fn times(x: f64, y: [f64; LANES]) -> [f64; LANES] {
    y.map(|y| x * y)
}

#[inline(always)]
pub(crate) fn plus(mut x: [f64; LANES], y: [f64; LANES]) -> [f64; LANES] {
    for l in 0..LANES {
        x[l] += y[l];
    }
    x
}

/// The rows of a block of four.
#[inline(always)]
#[expect(clippy::type_complexity, reason = "two pairs of rows")]
fn quarters(block: &[f64], stride: usize) -> ((&[f64], &[f64]), (&[f64], &[f64])) {
    let (first, second) = block.split_at(2 * stride);
    (first.split_at(stride), second.split_at(stride))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// The oracle: rows added one at a time, entry by entry.
        #[test]
        fn sums_are_those_of_sparse_rows(
            count in 0..200_usize,
            parameters in prop::collection::btree_set(0..40_usize, 1..30),
            seed in 0..1000_usize,
        ) {
            let parameters: Vec<usize> = parameters.into_iter().collect();
            // Small whole numbers: sums are exact in any order.
            let entry = |row: usize, i: usize| ((row * 31 + i * i * 7 + seed) % 11) as f64 - 5.0;
            let (split, last) = parameters.split_at(parameters.len() / 2);
            let mut sums = DenseSums::new(parameters.clone());
            let (mut slow, mut fast) = (Normal::new(40), Normal::new(40));
            for row in 0..count {
                let w = (row % 5) as f64;
                let dense: Vec<f64> = split.iter().map(|&i| entry(row, i)).collect();
                sums.push(&dense, last.iter().map(|&i| entry(row, i)), w);
                let first = split.iter().map(|&i| (i as u32, entry(row, i)));
                let sparse: Vec<(u32, f64)> =
                    first.chain(last.iter().map(|&i| (i as u32, entry(row, i)))).collect();
                slow.add_sparse(&sparse, w);
            }
            sums.add_to(&mut fast);
            prop_assert_eq!(&fast.gradient, &slow.gradient);
            for i in 0..40 {
                for j in i..40 {
                    prop_assert_eq!(fast.entry(i, j), slow.entry(i, j));
                }
            }
        }
    }
}
