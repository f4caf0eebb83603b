//! Normal equations of rows that are dense in a few parameters and sparse in the others, summed up block by block.

use std::ops::Range;

use switchback_noise::lanes::{LANES, Work, keep_apart, widest};

use crate::least_squares::dense_sums::{plus, times};
use crate::least_squares::normal::Normal;

/// Rows kept before they are summed up: few enough to stay near the processor.
const BLOCK: usize = 64;

/// `Σ x xᵀ` and `Σ x w` over rows `x` with entries of some parameters in every row, and of few of the others in each.
pub(crate) struct MixedSums {
    /// The parameters that every row has entries of, increasing.
    heads: Vec<usize>,
    /// The others.
    others: Range<usize>,
    /// Entries from one row to the next: those of the heads, the right-hand side, zeros up to whole vectors.
    stride: usize,
    /// Of the heads with each other and the right-hand side; of the others with these; row-major.
    head_sums: Vec<f64>,
    cross_sums: Vec<f64>,
    /// Of the others with each other, the lesser index first.
    other_sums: Vec<f64>,
    /// Rows not yet summed up.
    rows: Vec<f64>,
    terms: Vec<(u32, f64)>,
    ends: Vec<usize>,
}

impl MixedSums {
    pub(crate) fn new(heads: Vec<usize>, others: Range<usize>) -> Self {
        let stride = (heads.len() + 1).next_multiple_of(LANES);
        Self {
            head_sums: vec![0.0; heads.len() * stride],
            cross_sums: vec![0.0; others.len() * stride],
            other_sums: vec![0.0; others.len() * others.len()],
            rows: Vec::with_capacity(BLOCK * stride),
            terms: Vec::with_capacity(8 * BLOCK),
            ends: Vec::with_capacity(BLOCK),
            heads,
            others,
            stride,
        }
    }

    /// Adds a row: its entries of the heads, their last ones from `further`; different ones of the others, numbered from the first
    /// of these; and the right-hand side.
    #[inline]
    pub(crate) fn push(
        &mut self,
        heads: &[f64],
        further: impl Iterator<Item = f64>,
        others: &[(u32, f64)],
        w: f64,
    ) {
        self.rows.extend_from_slice(heads);
        self.rows.extend(further);
        self.rows.push(w);
        self.terms.extend_from_slice(others);
        self.ends.push(self.terms.len());
        self.rows.resize(self.ends.len() * self.stride, 0.0);
        if self.ends.len() == BLOCK {
            self.sum_up();
        }
    }

    fn sum_up(&mut self) {
        widest(Block { sums: self });
        self.rows.clear();
        self.terms.clear();
        self.ends.clear();
    }

    /// Adds the sums to normal equations of all parameters.
    pub(crate) fn add_to(mut self, normal: &mut Normal) {
        self.sum_up();
        let (count, w) = (self.others.len(), self.heads.len());
        normal.add_block(&self.heads, &self.head_sums, self.stride);
        for (i, &row) in self.heads.iter().enumerate() {
            normal.gradient[row] += self.head_sums[i * self.stride + w];
        }
        for (i, row) in self.others.clone().enumerate() {
            let sums = &self.cross_sums[i * self.stride..(i + 1) * self.stride];
            normal.gradient[row] += sums[w];
            for (&head, sum) in self.heads.iter().zip(sums) {
                normal.add_entry(row.min(head), row.max(head), *sum);
            }
            for (column, sum) in self.others.clone().zip(&self.other_sums[i * count..]).skip(i) {
                normal.add_entry(row, column, *sum);
            }
        }
    }
}

/// The rows kept, before they enter the sums.
struct Block<'a> {
    sums: &'a mut MixedSums,
}

impl Work for Block<'_> {
    #[inline(always)]
    fn run(self) {
        let MixedSums { heads, others, stride, head_sums, cross_sums, other_sums, rows, terms, ends } =
            self.sums;
        let (stride, count) = (*stride, others.len());
        let mut start = 0;
        for (row, &end) in rows.chunks_exact(stride).zip(&*ends) {
            let x = row.as_chunks::<LANES>().0;
            for (sums, &head) in head_sums.chunks_exact_mut(stride).zip(&row[..heads.len()]) {
                add(sums, head, x);
            }
            let terms = &terms[start..end];
            start = end;
            for (k, &(i, value)) in terms.iter().enumerate() {
                let i = i as usize;
                add(&mut cross_sums[i * stride..(i + 1) * stride], value, x);
                for &(j, other) in &terms[k..] {
                    let j = j as usize;
                    other_sums[i.min(j) * count + i.max(j)] += value * other;
                }
            }
        }
    }
}

/// `sums += scale·x`.
#[inline(always)]
fn add(sums: &mut [f64], scale: f64, x: &[[f64; LANES]]) {
    for (sum, x) in sums.as_chunks_mut::<LANES>().0.iter_mut().zip(x) {
        keep_apart();
        *sum = plus(*sum, times(scale, *x));
    }
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
            heads in 0..12_usize,
            further in 0..4_usize,
            others in 1..20_usize,
            seed in 0..1000_usize,
        ) {
            let size = heads + others + further;
            // Small whole numbers: sums are exact in any order.
            let entry = |row: usize, i: usize| ((row * 31 + i * i * 7 + seed) % 11) as f64 - 5.0;
            let last = heads + others..size;
            let mut sums = MixedSums::new((0..heads).chain(last.clone()).collect(), heads..heads + others);
            let (mut slow, mut fast) = (Normal::new(size), Normal::new(size));
            for row in 0..count {
                let w = (row % 5) as f64;
                let first: Vec<f64> = (0..heads).map(|i| entry(row, i)).collect();
                // Every third, in no order.
                let few: Vec<(u32, f64)> = (0..others)
                    .map(|i| (i * 7 + row) % others)
                    .filter(|i| others % 7 != 0 && (i + row) % 3 == 0)
                    .map(|i| (i as u32, entry(row, heads + i)))
                    .collect();
                sums.push(&first, last.clone().map(|i| entry(row, i)), &few, w);
                let mut whole: Vec<f64> = (0..size).map(|i| entry(row, i)).collect();
                whole[heads..heads + others].fill(0.0);
                few.iter().for_each(|&(i, x)| whole[heads + i as usize] = x);
                slow.add(&whole, w);
            }
            sums.add_to(&mut fast);
            prop_assert_eq!(&fast.gradient, &slow.gradient);
            for i in 0..size {
                for j in i..size {
                    prop_assert_eq!(fast.entry(i, j), slow.entry(i, j));
                }
            }
        }
    }
}
