//! The regression behind every fit: parameters, structure, and the stretches of data they meet.

use super::basis::Cell;

/// Orders and delay of the linear part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Structure {
    /// Order `n` of `A`.
    pub order: usize,
    /// Extra samples of delay; −1 for a direct term.
    pub delay: isize,
}

impl Structure {
    /// Number of coefficients of `B`: its lags run from `1 + delay` to `n + delay`, or to `n` where the delay is negative.
    pub fn numerator(&self) -> usize {
        self.order + self.lead()
    }

    /// Samples by which the first coefficient precedes the paper's: `−delay`, or 0.
    pub(super) fn lead(&self) -> usize {
        (-self.delay).max(0) as usize
    }

    /// Whether `other` has the same coefficients and one more lag on one side.
    pub(super) fn is_just_inside(&self, other: Self) -> bool {
        (self.delay == other.delay && self.order + 1 == other.order)
            || (self.order == other.order && self.delay == other.delay + 1 && self.delay <= 0)
    }

    /// Samples ahead of `t` that a prediction of `y(t)` looks at.
    pub(super) fn ahead(&self) -> usize {
        self.lead().saturating_sub(1)
    }

    /// Sample of `u` that coefficient `i` (from 0) weighs in `y(t)`; `t` must lie at least [`Self::memory`] from the start.
    pub(super) fn input(&self, t: usize, i: usize) -> usize {
        t.wrapping_add_signed(-1 - self.delay) - i
    }

    /// Oldest sample that a prediction looks back to.
    pub(super) fn memory(&self) -> usize {
        self.order + self.delay.max(0) as usize
    }
}

/// `A(q⁻¹) y(t) = Σᵢ bᵢ Σₖ f_k φ_k(t−d−i) + c`, in any scale shared between `b` and `f`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Parameters {
    pub(super) a: Vec<f64>,
    pub(super) b: Vec<f64>,
    pub(super) f: Vec<f64>,
    pub(super) c: f64,
}

impl Parameters {
    /// All parameters in the order a, b, f, c.
    pub(super) fn to_vec(&self) -> Vec<f64> {
        [&self.a[..], &self.b, &self.f, &[self.c]].concat()
    }

    /// This point moved by a step in the order a, b, f, c.
    pub(super) fn moved(&self, step: &[f64]) -> Self {
        let add = |x: &[f64], d: &[f64]| x.iter().zip(d).map(|(x, d)| x + d).collect();
        let (a, rest) = step.split_at(self.a.len());
        let (b, rest) = rest.split_at(self.b.len());
        let (f, c) = rest.split_at(self.f.len());
        Self { a: add(&self.a, a), b: add(&self.b, b), f: add(&self.f, f), c: self.c + c[0] }
    }

    /// The same system with knot values of unit root mean square.
    pub(super) fn balanced(mut self) -> Self {
        let size = (self.f.iter().map(|x| x * x).sum::<f64>() / self.f.len() as f64).sqrt();
        if size > 0.0 {
            self.f.iter_mut().for_each(|x| *x /= size);
            self.b.iter_mut().for_each(|x| *x *= size);
        }
        self
    }
}

/// A stretch of one record: outputs from `from` to `to` are to be explained, older samples are given.
#[derive(Debug, Clone, Copy)]
pub(super) struct Segment<'a> {
    pub(super) y: &'a [f64],
    pub(super) cells: &'a [Cell],
    pub(super) from: usize,
    pub(super) to: usize,
}

impl Segment<'_> {
    pub(super) fn len(&self) -> usize {
        self.to - self.from
    }

    /// Energy of the outputs to be explained about their mean.
    pub(super) fn energy(&self) -> f64 {
        let y = &self.y[self.from..self.to];
        let mean = y.iter().sum::<f64>() / y.len() as f64;
        y.iter().map(|y| (y - mean) * (y - mean)).sum()
    }
}
