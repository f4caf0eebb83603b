//! Rows without recursive filters.

use super::tapped;
use crate::assembly::convolve;
use crate::design::{Design, DesignTrack};
use crate::linear::Linear;
use crate::whitener::Whitener;

/// A moving-average filter from a sample on; what lies before the record is its first sample.
fn averaged(filter: &[f64], x: &[f64], from: usize) -> Vec<f64> {
    if filter.len() == 1 && filter[0] == 1.0 {
        return x.to_vec();
    }
    let mut out = vec![0.0; x.len()];
    for t in from..x.len() {
        out[t] = filter.iter().enumerate().map(|(k, c)| c * x[t.saturating_sub(k)]).sum();
    }
    out
}

/// Hands over the weighted derivatives of one track, indices increasing; whitening with `D` alone is a longer `b̃` and averaged
/// lags.
pub(super) fn sparse_rows(
    (design, track): (&Design, &DesignTrack),
    p: &Linear,
    whitener: &Whitener,
    weights: Option<&[f64]>,
    mut emit: impl FnMut(&mut Vec<(u32, f64)>),
) {
    let (na, nb, k, m) = (p.a.len(), p.b.len(), p.f.len(), p.d.len());
    let ar: Vec<f64> = std::iter::once(1.0).chain(whitener.ar.iter().copied()).collect();
    let b = convolve(&convolve(&p.b, &design.taps), &ar);
    let first = track.from.saturating_sub(na + nb + 1);
    let x = averaged(&ar, &track.x, first);
    let tapped = averaged(&ar, &tapped(design, track, p), first);
    let mut border = Sparse::new(k);
    let mut row: Vec<(u32, f64)> = Vec::with_capacity(64);
    for t in track.from..track.x.len() {
        let weight = weights.map_or(1.0, |w| w[t - track.from]);
        row.clear();
        if weight != 0.0 {
            row.extend((0..na).map(|i| (i as u32, weight * x[t - i - 1])));
            row.extend((0..nb).map(|j| ((na + j) as u32, -weight * tapped[t - j - 1])));
            for (j, b) in b.iter().enumerate() {
                border.add(track.rows.row(t.saturating_sub(j + 1)), -weight * b);
            }
            border.drain((na + nb) as u32, &mut row);
            for c in 0..m {
                let psi: f64 = ar.iter().enumerate().map(|(i, d)| d * track.columns[(t - i) * m + c]).sum();
                // Most columns are those of other tracks.
                if psi != 0.0 {
                    row.push(((na + nb + k + c) as u32, -weight * psi));
                }
            }
        }
        emit(&mut row);
    }
}

/// A sparse sum of sparse rows.
struct Sparse {
    value: Vec<f64>,
    present: Vec<bool>,
    index: Vec<u32>,
}

impl Sparse {
    fn new(size: usize) -> Self {
        Self { value: vec![0.0; size], present: vec![false; size], index: Vec::new() }
    }

    fn add(&mut self, row: &[(u32, f64)], scale: f64) {
        for &(i, x) in row {
            if !std::mem::replace(&mut self.present[i as usize], true) {
                self.index.push(i);
            }
            self.value[i as usize] += scale * x;
        }
    }

    /// Moves the sum to a row, by increasing index.
    fn drain(&mut self, offset: u32, row: &mut Vec<(u32, f64)>) {
        self.index.sort_unstable();
        for i in self.index.drain(..) {
            self.present[i as usize] = false;
            row.push((offset + i, std::mem::take(&mut self.value[i as usize])));
        }
    }
}
