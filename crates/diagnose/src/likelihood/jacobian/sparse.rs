//! Rows without recursive filters.

use std::ops::Range;

use super::tapped::tapped;
use crate::likelihood::design::{Design, DesignScaled};
use crate::likelihood::whitener::{LEAD, Whitener};
use crate::model::augmented::convolve;
use crate::model::linear::Linear;

/// What whitening by a moving average makes of one record.
struct Averaged<'a> {
    /// The average, the leading one included.
    ar: &'a [f64],
    /// Whitened `x` and `taps ∗ ũ`, from the first sample that is needed on.
    x: Vec<f64>,
    tapped: Vec<f64>,
    first: usize,
    /// `b̃` times the average.
    b: Vec<f64>,
}

impl<'a> Averaged<'a> {
    /// For some samples, of which lags up to `lags` are needed.
    fn new(ar: &'a [f64], signals: [&[f64]; 2], b: &[f64], (samples, lags): (Range<usize>, usize)) -> Self {
        let first = samples.start.saturating_sub(lags);
        let [x, tapped] = signals.map(|signal| averaged(ar, signal, first..samples.end));
        Self { ar, x, tapped, first, b: convolve(b, ar) }
    }
}

/// A moving-average filter over some samples; what lies before the record is its first sample.
fn averaged(filter: &[f64], x: &[f64], samples: Range<usize>) -> Vec<f64> {
    if filter.len() == 1 && filter[0] == 1.0 {
        return x[samples].to_vec();
    }
    let at = |t: usize| filter.iter().enumerate().map(|(k, c)| c * x[t.saturating_sub(k)]).sum();
    samples.map(at).collect()
}

/// Counted samples with the length of the whitening filter there: no error before the [`LEAD`] is known.
fn spans(scaled: &DesignScaled, ar: usize) -> impl Iterator<Item = (Range<usize>, usize)> {
    let (from, end) = (scaled.from, scaled.x.len());
    let known = from - from.saturating_sub(LEAD);
    let short = ar.saturating_sub(known);
    let whole = (from + short).min(end);
    (from..whole).map(move |t| (t..t + 1, known + t - from)).chain([(whole..end, ar)])
}

/// A row: the derivatives with respect to `A` and `B`, and what of those with respect to the border values and the coefficients of
/// disturbances is not zero, numbered from the first border value on, in no order.
#[derive(Debug, Default)]
pub(super) struct SparseRow {
    pub(super) dynamics: Vec<f64>,
    pub(super) others: Vec<(u32, f64)>,
}

impl SparseRow {
    fn clear(&mut self) {
        self.dynamics.clear();
        self.others.clear();
    }

    /// Adds to the sum of the border features: so few terms that a search among them is quick.
    fn add(&mut self, features: &[(u32, f64)], scale: f64) {
        for &(i, x) in features {
            match self.others.iter_mut().find(|term| term.0 == i) {
                Some(term) => term.1 += scale * x,
                None => self.others.push((i, scale * x)),
            }
        }
    }
}

/// Hands over the weighted derivatives of one record; whitening with `D` alone is a longer `b̃` and averaged lags.
pub(super) fn sparse_rows(
    (design, scaled): (&Design, &DesignScaled),
    p: &Linear,
    whitener: &Whitener,
    weights: Option<&[f64]>,
    mut emit: impl FnMut(&SparseRow),
) {
    let (na, nb, k) = (p.a.len(), p.b.len(), p.f.len());
    let ar: Vec<f64> = std::iter::once(1.0).chain(whitener.ar.iter().copied()).collect();
    let b = convolve(&p.b, &design.taps);
    let tapped = tapped(design, scaled, p);
    let numbers = &scaled.columns.numbers;
    let mut row = SparseRow::default();
    for (samples, length) in spans(scaled, whitener.ar.len()) {
        let signals = [&scaled.x[..], &tapped];
        let white = Averaged::new(&ar[..=length], signals, &b, (samples.clone(), na.max(nb)));
        for t in samples {
            let weight = weights.map_or(1.0, |w| w[t - scaled.from]);
            row.clear();
            if weight == 0.0 {
                row.dynamics.resize(na + nb, 0.0);
                emit(&row);
                continue;
            }
            let now = t - white.first;
            row.dynamics.extend(white.x[now - na..now].iter().rev().map(|x| weight * x));
            row.dynamics.extend(white.tapped[now - nb..now].iter().rev().map(|u| -weight * u));
            for (j, b) in white.b.iter().enumerate() {
                row.add(scaled.rows.row(t.saturating_sub(j + 1)), -weight * b);
            }
            for (c, number) in numbers.iter().enumerate() {
                let lags = white.ar.iter().enumerate();
                let psi: f64 = lags.map(|(i, d)| d * scaled.columns.row(t - i)[c]).sum();
                if psi != 0.0 {
                    row.others.push(((k + number) as u32, -weight * psi));
                }
            }
            emit(&row);
        }
    }
}
