//! The regression behind every fit: parameters, structure, and the stretches of data they meet.

use super::basis::Basis;
use super::cells::Cells;
use super::error::FreeError;
use std::ops::Range;

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
    pub(crate) fn numerator(&self) -> usize {
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
    pub(super) cells: &'a Cells,
    pub(super) from: usize,
    pub(super) to: usize,
    /// How many samples of the record each one stands for, over the same indices as `y`; one where there are none.
    pub(super) weights: Option<&'a [f64]>,
    /// The first sample whose error counts; those before it let the run forget the noise of the outputs from which it starts.
    pub(super) counted_from: usize,
}

impl<'a> Segment<'a> {
    /// The part of a range of a record whose inputs and past outputs are all known and lie inside it.
    pub(super) fn usable(
        structure: Structure,
        y: &'a [f64],
        cells: &'a Cells,
        range: Range<usize>,
    ) -> Option<Self> {
        let from = range.start + structure.memory();
        let to = range.end.min(y.len() - structure.ahead().min(y.len()));
        (from < to).then_some(Self { y, cells, from, to, weights: None, counted_from: from })
    }

    /// The same stretch, errors before a sample not counted; none where that leaves nothing.
    pub(super) fn counted_from(self, sample: usize) -> Option<Self> {
        let counted_from = self.from.max(sample);
        (counted_from < self.to).then_some(Self { counted_from, ..self })
    }

    /// Samples whose errors count.
    pub(super) fn counted(&self) -> usize {
        self.to - self.counted_from
    }

    pub(super) fn len(&self) -> usize {
        self.to - self.from
    }

    /// The weight of a sample.
    pub(super) fn weight(&self, t: usize) -> f64 {
        self.weights.map_or(1.0, |weights| weights[t])
    }

    /// Energy of the outputs that count about their mean.
    pub(super) fn energy(&self) -> f64 {
        let y = &self.y[self.counted_from..self.to];
        let mean = y.iter().sum::<f64>() / y.len() as f64;
        y.iter().map(|y| (y - mean) * (y - mean)).sum()
    }
}

impl Basis {
    /// Samples beside each knot.
    pub(super) fn visits(&self, segments: &[Segment]) -> Vec<usize> {
        let mut visits = vec![0; self.features() + 1];
        for cell in segments.iter().flat_map(|s| (s.from..s.to).map(|t| s.cells.at(t))) {
            visits[cell.main.knot] += 1;
            visits[cell.main.knot + 1] += 1;
        }
        visits
    }

    /// Refuses a knot that no sample shows anything about.
    pub(super) fn check_visits(&self, segments: &[Segment]) -> Result<(), FreeError> {
        let Some(knot) = self.visits(segments).iter().position(|&count| count == 0) else { return Ok(()) };
        let descending = self.descending();
        Err(match knot.checked_sub(descending.len()) {
            None => FreeError::UnvisitedKnot { curve: "descending", v: descending[knot] },
            Some(knot) => FreeError::UnvisitedKnot { curve: "ascending", v: self.ascending()[knot] },
        })
    }

    /// Refuses fewer than two samples a parameter.
    pub(super) fn check_length(&self, structure: Structure, segments: &[Segment]) -> Result<(), FreeError> {
        let samples = segments.iter().map(Segment::counted).sum();
        let parameters = structure.order + structure.numerator() + self.features();
        if samples < 2 * parameters { Err(FreeError::TooShort { samples, parameters }) } else { Ok(()) }
    }
}
