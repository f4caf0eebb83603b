//! The inner loops of the pass, one replicate a lane: rows are samples, columns are replicates.

use super::width::Kernel;

/// Lags whose sums stay in registers together.
const LAGS_AT_ONCE: usize = 4;

/// `x(t) = w(t) + Σ_j c_j w(t−j)` over a block; the rows of `w` begin with as many past samples as `ma` has
/// coefficients.
pub(super) struct MovingAverage<'a> {
    pub(super) ma: &'a [f64],
    pub(super) w: &'a [f64],
    pub(super) x: &'a mut [f64],
}

impl Kernel for MovingAverage<'_> {
    #[inline(always)]
    fn run<const L: usize>(self) {
        let (w, _) = self.w.as_chunks::<L>();
        let (x, _) = self.x.as_chunks_mut::<L>();
        let q = self.ma.len();
        for (t, x) in x.iter_mut().enumerate() {
            let mut sum = w[q + t];
            for (j, c) in self.ma.iter().enumerate() {
                let past = &w[q + t - 1 - j];
                for l in 0..L {
                    sum[l] += c * past[l];
                }
            }
            *x = sum;
        }
    }
}

/// `e(t) = x(t) − Σᵢ aᵢ e(t−i)` in place, and `sums[k·L + l] += Σ_t e(t) e(t−k)` for `k = 0…n`.
///
/// The first `history` rows of `e` hold its past, the others x on entry and e on return.
pub(super) struct Advance<'a> {
    pub(super) ar: &'a [f64],
    pub(super) history: usize,
    pub(super) e: &'a mut [f64],
    pub(super) sums: &'a mut [f64],
}

impl Kernel for Advance<'_> {
    #[inline(always)]
    fn run<const L: usize>(self) {
        let (e, _) = self.e.as_chunks_mut::<L>();
        let (sums, _) = self.sums.as_chunks_mut::<L>();
        let rows = &mut e[self.history - self.ar.len()..];
        match (self.ar, &mut *sums) {
            // An estimator of the right order asks for as many lags as the filter has coefficients: both in
            // one go.
            ([a1], [_, _]) => recursion_with_products(&[*a1], rows, sums),
            ([a1, a2], [_, _, _]) => recursion_with_products(&[*a1, *a2], rows, sums),
            ([a1, a2, a3], [_, _, _, _]) => recursion_with_products(&[*a1, *a2, *a3], rows, sums),
            ([a1, a2, a3, a4], [_, _, _, _, _]) => recursion_with_products(&[*a1, *a2, *a3, *a4], rows, sums),
            (ar, _) => {
                recursion(ar, rows);
                let lags = sums.len() - 1;
                auto_products(&e[self.history - lags..], sums);
            }
        }
    }
}

/// Recursion and products with the past and the sums in registers. The newest term of the recursion comes
/// last: it alone waits for the sample before, and the products fill the wait.
#[inline(always)]
fn recursion_with_products<const L: usize, const P: usize>(
    a: &[f64; P],
    rows: &mut [[f64; L]],
    sums: &mut [[f64; L]],
) {
    let (start, rows) = rows.split_at_mut(P);
    let mut past: [[f64; L]; P] = std::array::from_fn(|i| start[P - 1 - i]);
    // Whole arrays in and out: an index that varies would keep them in memory.
    let (square_sum, product_sums) = sums.split_first_mut().expect("lag zero is always summed");
    let product_sums = product_sums.first_chunk_mut::<P>().expect("as many lags as coefficients");
    let (mut square, mut products) = (*square_sum, *product_sums);
    for row in rows {
        let mut e = *row;
        for i in (0..P).rev() {
            for l in 0..L {
                e[l] -= a[i] * past[i][l];
            }
        }
        for l in 0..L {
            square[l] += e[l] * e[l];
        }
        let mut newer = e;
        for i in 0..P {
            let now = past[i];
            for l in 0..L {
                products[i][l] += e[l] * now[l];
            }
            past[i] = newer;
            newer = now;
        }
        *row = e;
    }
    *square_sum = square;
    *product_sums = products;
}

/// The recursion of any order, from memory.
#[inline(always)]
fn recursion<const L: usize>(a: &[f64], rows: &mut [[f64; L]]) {
    for t in a.len()..rows.len() {
        let mut e = rows[t];
        for (i, a) in a.iter().enumerate().rev() {
            let past = &rows[t - 1 - i];
            for l in 0..L {
                e[l] -= a * past[l];
            }
        }
        rows[t] = e;
    }
}

/// The products of any number n of lags, over the rows of `e` after the first n.
#[inline(always)]
fn auto_products<const L: usize>(e: &[[f64; L]], sums: &mut [[f64; L]]) {
    let n = sums.len() - 1;
    for (group, sums) in sums.chunks_mut(LAGS_AT_ONCE).enumerate() {
        let first = group * LAGS_AT_ONCE;
        match sums {
            [_] => products::<L, 1>(e, n, first, sums),
            [_, _] => products::<L, 2>(e, n, first, sums),
            [_, _, _] => products::<L, 3>(e, n, first, sums),
            _ => products::<L, LAGS_AT_ONCE>(e, n, first, sums),
        }
    }
}

/// The products at lags `first … first + G − 1`.
#[inline(always)]
fn products<const L: usize, const G: usize>(e: &[[f64; L]], n: usize, first: usize, sums: &mut [[f64; L]]) {
    let sums = sums.first_chunk_mut::<G>().expect("a group of G lags");
    let mut sum = *sums;
    let now = &e[n..];
    let past: [&[[f64; L]]; G] = std::array::from_fn(|g| &e[n - first - g..][..now.len()]);
    for t in 0..now.len() {
        for g in 0..G {
            for l in 0..L {
                sum[g][l] += now[t][l] * past[g][t][l];
            }
        }
    }
    *sums = sum;
}

/// Adds the rows of `e` to `fold`, one row a phase, cyclically from `phase` on.
pub(super) struct Fold<'a> {
    pub(super) e: &'a [f64],
    pub(super) fold: &'a mut [f64],
    pub(super) phase: usize,
}

impl Kernel for Fold<'_> {
    #[inline(always)]
    fn run<const L: usize>(self) {
        let (e, _) = self.e.as_chunks::<L>();
        let (fold, _) = self.fold.as_chunks_mut::<L>();
        // Phase by phase, so that a sum is loaded and stored once and not at every visit.
        let period = fold.len();
        let (before, after) = fold.split_at_mut(self.phase);
        for (first, sum) in after.iter_mut().chain(before).enumerate().take(e.len()) {
            let mut total = *sum;
            let mut t = first;
            while t < e.len() {
                for l in 0..L {
                    total[l] += e[t][l];
                }
                t += period;
            }
            *sum = total;
        }
    }
}
