//! The inner loops of the pass, one replicate a lane: rows are samples, columns are replicates.

use super::width::Kernel;

/// Lags whose sums stay in registers together.
const LAGS_AT_ONCE: usize = 4;

/// `x(t) = w(t) + Σ_j c_j w(t−j)` over a block; the rows of `w` begin with as many past samples as `ma` has coefficients.
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

/// `e(t) = x(t) − Σᵢ aᵢ e(t−i)` over a block, in place: rows from `history` on hold x and receive e, the rows before hold past e.
pub(super) struct AutoRegression<'a> {
    pub(super) ar: &'a [f64],
    pub(super) history: usize,
    pub(super) e: &'a mut [f64],
}

impl Kernel for AutoRegression<'_> {
    #[inline(always)]
    fn run<const L: usize>(self) {
        let (e, _) = self.e.as_chunks_mut::<L>();
        let rows = &mut e[self.history - self.ar.len()..];
        match self.ar {
            [] => {}
            [a1] => recursion(&[*a1], rows),
            [a1, a2] => recursion(&[*a1, *a2], rows),
            [a1, a2, a3] => recursion(&[*a1, *a2, *a3], rows),
            [a1, a2, a3, a4] => recursion(&[*a1, *a2, *a3, *a4], rows),
            ar => long_recursion(ar, rows),
        }
    }
}

/// The recursion with its past in registers. The newest term comes last: it alone waits for the sample before.
#[inline(always)]
fn recursion<const L: usize, const P: usize>(a: &[f64; P], rows: &mut [[f64; L]]) {
    let (start, rows) = rows.split_at_mut(P);
    let mut past: [[f64; L]; P] = std::array::from_fn(|i| start[P - 1 - i]);
    for row in rows {
        let mut e = *row;
        for i in (0..P).rev() {
            for l in 0..L {
                e[l] -= a[i] * past[i][l];
            }
        }
        for i in (1..P).rev() {
            past[i] = past[i - 1];
        }
        past[0] = e;
        *row = e;
    }
}

/// The same for any order, from memory.
#[inline(always)]
fn long_recursion<const L: usize>(a: &[f64], rows: &mut [[f64; L]]) {
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

/// Adds `Σ_t e(t) e(t−k)` to `sums[k·L + l]` for every lag `k = 0…n`, over the rows of `e` after the first n.
pub(super) struct AutoProducts<'a> {
    pub(super) e: &'a [f64],
    pub(super) sums: &'a mut [f64],
}

impl Kernel for AutoProducts<'_> {
    #[inline(always)]
    fn run<const L: usize>(self) {
        let (e, _) = self.e.as_chunks::<L>();
        let (sums, _) = self.sums.as_chunks_mut::<L>();
        let n = sums.len() - 1;
        let mut first = 0;
        for sums in sums.chunks_mut(LAGS_AT_ONCE) {
            match sums {
                [_] => products::<L, 1>(e, n, first, sums),
                [_, _] => products::<L, 2>(e, n, first, sums),
                [_, _, _] => products::<L, 3>(e, n, first, sums),
                _ => products::<L, LAGS_AT_ONCE>(e, n, first, sums),
            }
            first += LAGS_AT_ONCE;
        }
    }
}

/// The products at lags `first … first + G − 1`.
#[inline(always)]
fn products<const L: usize, const G: usize>(e: &[[f64; L]], n: usize, first: usize, sums: &mut [[f64; L]]) {
    let mut sum: [[f64; L]; G] = std::array::from_fn(|g| sums[g]);
    let now = &e[n..];
    let past: [&[[f64; L]]; G] = std::array::from_fn(|g| &e[n - first - g..][..now.len()]);
    for t in 0..now.len() {
        for g in 0..G {
            for l in 0..L {
                sum[g][l] += now[t][l] * past[g][t][l];
            }
        }
    }
    sums.copy_from_slice(&sum);
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
        let (mut e, _) = self.e.as_chunks::<L>();
        let (fold, _) = self.fold.as_chunks_mut::<L>();
        let mut phase = self.phase;
        while !e.is_empty() {
            let (now, rest) = e.split_at(e.len().min(fold.len() - phase));
            for (sum, e) in fold[phase..].iter_mut().zip(now) {
                for l in 0..L {
                    sum[l] += e[l];
                }
            }
            phase = 0;
            e = rest;
        }
    }
}
