//! Rows behind recursive filters.

use std::ops::Range;

use super::tapped::tapped;
use crate::likelihood::design::{Design, DesignScaled};
use crate::likelihood::whitener::{LEAD, Whitener};
use crate::model::augmented::convolve;
use crate::model::linear::Linear;

/// The parameters that act on one record: of border values nobody visits there and of other records' disturbances all derivatives
/// are zero.
pub(super) struct Active<'a> {
    /// Numbers of the border values (and columns).
    border: Vec<usize>,
    /// Where each border value stands among these; of no meaning for others.
    place: Vec<u32>,
    /// Numbers of the equation columns.
    columns: &'a [usize],
}

impl<'a> Active<'a> {
    pub(super) fn on(scaled: &'a DesignScaled, p: &Linear) -> Self {
        let touched = scaled.rows.touched(p.f.len());
        let border: Vec<usize> = (0..touched.len()).filter(|&i| touched[i]).collect();
        let mut place = vec![0; touched.len()];
        border.iter().zip(0..).for_each(|(&i, at)| place[i] = at);
        Self { border, place, columns: &scaled.columns.numbers }
    }

    /// Numbers of the parameters among all, in the order of a row.
    pub(super) fn parameters(&self, p: &Linear) -> Vec<usize> {
        let dynamics = p.a.len() + p.b.len();
        let border = self.border.iter().map(|i| dynamics + i);
        let columns = self.columns.iter().map(|j| dynamics + p.f.len() + j);
        (0..dynamics).chain(border).chain(columns).collect()
    }
}

/// Hands over the derivatives of one record with respect to the parameters that act on it, without weights: a row a counted
/// sample, to be changed at will.
pub(super) fn dense_rows(
    (design, scaled): (&Design, &DesignScaled),
    p: &Linear,
    whitener: &Whitener,
    active: &Active<'_>,
    mut emit: impl FnMut(&mut [f64]),
) {
    let (na, nb, k) = (p.a.len(), p.b.len(), active.border.len());
    let size = na + nb + k + active.columns.len();
    let negated: Vec<f64> = convolve(&p.b, &design.taps).iter().map(|b| -b).collect();
    let tapped = tapped(design, scaled, p);
    let first = scaled.from.saturating_sub(LEAD);
    // In a simulation the lags are those of the simulated output, the measured one less the error.
    let error = design.criterion.simulates().then(|| whitener.apply(design.errors(scaled, p)));
    let error = |t: usize| match &error {
        Some(error) if t >= first => error[t - first],
        _ => 0.0,
    };
    let memory = design.poles.len().max(whitener.ar.len());
    let mut raw = Ring::new(size, memory + 1);
    let border = Filtered::new((design, scaled), &active.place, na + nb..na + nb + k, negated);
    let mut white = Ring::new(size, whitener.ma.len() + 1);
    let mut out = vec![0.0; size];
    let mut emit = |row: &[f64]| {
        out.copy_from_slice(row);
        emit(&mut out);
    };
    for t in 0..scaled.x.len() {
        border.write(&mut raw, t);
        if t < first {
            continue;
        }
        let row = raw.row_mut(t);
        for i in 0..na {
            let past = t.saturating_sub(i + 1);
            row[i] = scaled.x[past] - error(past);
        }
        for j in 0..nb {
            row[na + j] = -tapped[t.saturating_sub(j + 1)];
        }
        for (x, psi) in row[na + nb + k..].iter_mut().zip(scaled.columns.row(t)) {
            *x = -psi;
        }
        if whitener.ar.is_empty() && whitener.ma.is_empty() {
            if t >= scaled.from {
                emit(raw.row(t));
            }
            continue;
        }
        let now = white.row_mut(t);
        now.copy_from_slice(raw.row(t));
        for (i, d) in whitener.ar.iter().enumerate().filter(|(i, _)| t > first + i) {
            add_scaled(now, raw.row(t - i - 1), *d);
        }
        for (i, c) in whitener.ma.iter().enumerate().filter(|(i, _)| t > first + i) {
            white.add_past(t, i + 1, -c, 0..size);
        }
        if t >= scaled.from {
            emit(white.row(t));
        }
    }
}

fn add_scaled(target: &mut [f64], source: &[f64], scale: f64) {
    for (x, y) in target.iter_mut().zip(source) {
        *x += scale * y;
    }
}

/// The last few rows of a dense matrix.
struct Ring {
    width: usize,
    depth: usize,
    data: Vec<f64>,
}

impl Ring {
    fn new(width: usize, depth: usize) -> Self {
        Self { width, depth, data: vec![0.0; width * depth] }
    }

    fn row(&self, t: usize) -> &[f64] {
        let at = t % self.depth * self.width;
        &self.data[at..at + self.width]
    }

    fn row_mut(&mut self, t: usize) -> &mut [f64] {
        let at = t % self.depth * self.width;
        &mut self.data[at..at + self.width]
    }

    /// `row(t) += scale·row(t − lag)` on some columns.
    fn add_past(&mut self, t: usize, lag: usize, scale: f64, columns: Range<usize>) {
        let (now, past) = (t % self.depth * self.width, (t - lag) % self.depth * self.width);
        let (low, high) = self.data.split_at_mut(now.max(past));
        let (now, past) = if now > past { (high, &low[past..]) } else { (&mut low[now..], &*high) };
        add_scaled(&mut now[columns.clone()], &past[columns], scale);
    }
}

/// Border features behind a filter `Σ bⱼ q^−(j+1) / (1 + poles)`, at rest before the record.
///
/// The features are sparse: only the poles' recursion touches whole rows.
struct Filtered<'a> {
    scaled: &'a DesignScaled,
    poles: &'a [f64],
    /// Place of each feature among its columns.
    place: &'a [u32],
    /// Coefficients of lags 1, 2, ….
    b: Vec<f64>,
    columns: Range<usize>,
    before: Vec<f64>,
}

impl<'a> Filtered<'a> {
    fn new(
        (design, scaled): (&'a Design, &'a DesignScaled),
        place: &'a [u32],
        columns: Range<usize>,
        b: Vec<f64>,
    ) -> Self {
        let rest = b.iter().sum::<f64>() / (1.0 + design.poles.iter().sum::<f64>());
        let mut before = vec![0.0; columns.len()];
        for &(i, x) in scaled.rows.row(0) {
            before[place[i as usize] as usize] += x * rest;
        }
        Self { scaled, poles: &design.poles, place, b, columns, before }
    }

    /// Writes its columns of row `t`, the one after the last.
    fn write(&self, ring: &mut Ring, t: usize) {
        let row = &mut ring.row_mut(t)[self.columns.clone()];
        row.fill(0.0);
        for (j, b) in self.b.iter().enumerate() {
            for &(i, x) in self.scaled.rows.row(t.saturating_sub(j + 1)) {
                row[self.place[i as usize] as usize] += b * x;
            }
        }
        for (lag, p) in self.poles.iter().enumerate() {
            if t > lag {
                ring.add_past(t, lag + 1, -p, self.columns.clone());
            } else {
                add_scaled(&mut ring.row_mut(t)[self.columns.clone()], &self.before, -p);
            }
        }
    }
}

/// Border features behind the poles, row-major, `k` a sample.
pub(crate) fn filtered_rows(design: &Design, scaled: &DesignScaled, k: usize) -> Vec<f64> {
    // What is written for one sample ahead is the feature itself.
    let place: Vec<u32> = (0..k as u32).collect();
    let features = Filtered::new((design, scaled), &place, 0..k, vec![1.0]);
    let mut ring = Ring::new(k, design.poles.len() + 1);
    let mut out = Vec::with_capacity(scaled.x.len() * k);
    features.write(&mut ring, 0);
    for t in 1..=scaled.x.len() {
        features.write(&mut ring, t);
        out.extend_from_slice(ring.row(t));
    }
    out
}
