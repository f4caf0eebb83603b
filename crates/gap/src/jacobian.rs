//! Derivatives of the innovations with respect to the linear parameters, one row a counted sample.
//!
//! ```text
//! ∂e(t)/∂aᵢ = x(t−i),  ∂e/∂bⱼ = −(taps ∗ ũ)(t−j),  ∂e/∂f = −Σ b̃ⱼ·rows(t−j)/den,  ∂e/∂d = −ψ(t);   ∂w = D/C·∂e
//! ```
//!
//! A hat function touches two border values, so rows are sparse unless a recursive filter spreads them.

use crate::assembly::convolve;
use crate::design::{Design, DesignTrack};
use crate::linear::Linear;
use crate::normal::Normal;
use crate::rows::Rows;
use crate::whitener::{LEAD, Whitener};

/// Weighted derivatives, all tracks one after the other.
#[derive(Debug, Clone)]
pub(crate) struct Jacobian {
    columns: usize,
    store: Store,
}

#[derive(Debug, Clone)]
enum Store {
    Sparse(Rows),
    /// Row-major.
    Dense(Vec<f64>),
}

impl Jacobian {
    /// The derivatives at `p`; each row times its weight.
    pub(crate) fn new(
        design: &Design,
        p: &Linear,
        whitener: &Whitener,
        weights: Option<&[Vec<f64>]>,
    ) -> Self {
        let spread = !design.poles.is_empty() || !whitener.ma.is_empty() || whitener.ar.len() > LEAD;
        let columns = p.len();
        let store = if spread {
            let mut out = Vec::with_capacity(design.samples() * columns);
            for (number, track) in design.tracks.iter().enumerate() {
                dense_rows(&mut out, (design, track), p, whitener, weights.map(|w| &w[number][..]));
            }
            Store::Dense(out)
        } else {
            let mut out = Rows::with_capacity(design.samples());
            for (number, track) in design.tracks.iter().enumerate() {
                sparse_rows(&mut out, (design, track), p, whitener, weights.map(|w| &w[number][..]));
            }
            Store::Sparse(out)
        };
        Self { columns, store }
    }

    /// `Σ x xᵀ` and `Σ x w` for weighted innovations `w`, with the columns of `extra` appended.
    pub(crate) fn normal(&self, w: &[f64], extra: &[Vec<f64>]) -> Normal {
        let mut normal = Normal::new(self.columns + extra.len());
        match &self.store {
            Store::Sparse(rows) => {
                for (t, &w) in w.iter().enumerate() {
                    let (index, value) = rows.row(t);
                    normal.add_sparse(index, value, w);
                }
            }
            Store::Dense(rows) => normal.add_dense(rows, self.columns, w),
        }
        for (j, column) in extra.iter().enumerate() {
            let at = self.columns + j;
            for (i, x) in self.cross(column).into_iter().enumerate() {
                normal.set(i, at, x);
            }
            for (k, other) in extra.iter().enumerate().skip(j) {
                normal.set(at, self.columns + k, column.iter().zip(other).map(|(x, y)| x * y).sum());
            }
            normal.gradient[at] = column.iter().zip(w).map(|(x, w)| x * w).sum();
        }
        normal
    }

    /// `Σ x·c` for a weighted column `c`; zeros of `c` cost a comparison.
    pub(crate) fn cross(&self, column: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.columns];
        for (t, &c) in column.iter().enumerate().filter(|(_, c)| **c != 0.0) {
            match &self.store {
                Store::Sparse(rows) => {
                    let (index, value) = rows.row(t);
                    for (&i, x) in index.iter().zip(value) {
                        out[i as usize] += x * c;
                    }
                }
                Store::Dense(rows) => {
                    let row = &rows[t * self.columns..(t + 1) * self.columns];
                    for (o, x) in out.iter_mut().zip(row) {
                        *o += x * c;
                    }
                }
            }
        }
        out
    }
}

/// `taps ∗ ũ`: what the coefficients of B multiply.
fn tapped(design: &Design, track: &DesignTrack, p: &Linear) -> Vec<f64> {
    let u = design.input(track, &p.f);
    if design.taps.len() == 1 && design.taps[0] == 1.0 {
        return u;
    }
    (0..u.len())
        .map(|t| design.taps.iter().enumerate().map(|(k, c)| c * u[t.saturating_sub(k)]).sum())
        .collect()
}

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

/// Rows without recursive filters: whitening with `D` alone is a longer `b̃` and averaged lags.
fn sparse_rows(
    out: &mut Rows,
    (design, track): (&Design, &DesignTrack),
    p: &Linear,
    whitener: &Whitener,
    weights: Option<&[f64]>,
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
                row.push(((na + nb + k + c) as u32, -weight * psi));
            }
        }
        out.push(&row, 1.0);
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

    fn add(&mut self, (index, value): (&[u32], &[f64]), scale: f64) {
        for (&i, x) in index.iter().zip(value) {
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

/// Rows behind recursive filters.
fn dense_rows(
    out: &mut Vec<f64>,
    (design, track): (&Design, &DesignTrack),
    p: &Linear,
    whitener: &Whitener,
    weights: Option<&[f64]>,
) {
    let (na, nb, k, m) = (p.a.len(), p.b.len(), p.f.len(), p.d.len());
    let size = p.len();
    let b = convolve(&p.b, &design.taps);
    let tapped = tapped(design, track, p);
    let mut features = Features::new(design, track, k, b.len());
    let first = track.from.saturating_sub(LEAD);
    // In a simulation the lags are those of the simulated output, the measured one less the error.
    let error = design.criterion.simulates().then(|| whitener.apply(design.errors(track, p)));
    let error = |t: usize| match &error {
        Some(error) if t >= first => error[t - first],
        _ => 0.0,
    };
    let mut raw = Ring::new(size, whitener.ar.len() + 1);
    let mut white = Ring::new(size, whitener.ma.len() + 1);
    for t in 0..track.x.len() {
        features.advance(t);
        if t < first {
            continue;
        }
        let row = raw.row_mut(t);
        for i in 0..na {
            let past = t.saturating_sub(i + 1);
            row[i] = track.x[past] - error(past);
        }
        for j in 0..nb {
            row[na + j] = -tapped[t.saturating_sub(j + 1)];
        }
        let border = &mut row[na + nb..na + nb + k];
        border.fill(0.0);
        for (j, b) in b.iter().enumerate() {
            add_scaled(border, features.at(t.saturating_sub(j + 1)), -b);
        }
        for c in 0..m {
            row[na + nb + k + c] = -track.columns[t * m + c];
        }
        let now = white.row_mut(t);
        now.copy_from_slice(raw.row(t));
        for (i, d) in whitener.ar.iter().enumerate().filter(|(i, _)| t > first + i) {
            add_scaled(now, raw.row(t - i - 1), *d);
        }
        for (i, c) in whitener.ma.iter().enumerate().filter(|(i, _)| t > first + i) {
            white.add_past(t, i + 1, -c);
        }
        if t >= track.from {
            let weight = weights.map_or(1.0, |w| w[t - track.from]);
            out.extend(white.row(t).iter().map(|x| weight * x));
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

    /// `row(t) += scale·row(t − lag)`.
    fn add_past(&mut self, t: usize, lag: usize, scale: f64) {
        let (now, past) = (t % self.depth * self.width, (t - lag) % self.depth * self.width);
        for i in 0..self.width {
            self.data[now + i] += scale * self.data[past + i];
        }
    }
}

/// Border features behind the poles, at rest before the record.
struct Features<'a> {
    track: &'a DesignTrack,
    poles: &'a [f64],
    ring: Ring,
    before: Vec<f64>,
}

impl<'a> Features<'a> {
    fn new(design: &'a Design, track: &'a DesignTrack, width: usize, lags: usize) -> Self {
        let rest = 1.0 / (1.0 + design.poles.iter().sum::<f64>());
        let mut before = vec![0.0; width];
        let (index, value) = track.rows.row(0);
        for (&i, x) in index.iter().zip(value) {
            before[i as usize] += x * rest;
        }
        // Early samples look back at sample 0: the ring must not have dropped it.
        let depth = lags.max(design.poles.len()) + 1;
        Self { track, poles: &design.poles, ring: Ring::new(width, depth), before }
    }

    /// Computes row `t`, the one after the last.
    fn advance(&mut self, t: usize) {
        self.ring.row_mut(t).fill(0.0);
        let (index, value) = self.track.rows.row(t);
        for (&i, x) in index.iter().zip(value) {
            self.ring.row_mut(t)[i as usize] += x;
        }
        for (lag, p) in self.poles.iter().enumerate() {
            if t > lag {
                self.ring.add_past(t, lag + 1, -p);
            } else {
                add_scaled(self.ring.row_mut(t), &self.before, -p);
            }
        }
    }

    fn at(&self, t: usize) -> &[f64] {
        self.ring.row(t)
    }
}

/// Border features behind the poles, row-major, `k` a sample.
pub(crate) fn filtered_rows(design: &Design, track: &DesignTrack, k: usize) -> Vec<f64> {
    let mut features = Features::new(design, track, k, 0);
    let mut out = Vec::with_capacity(track.x.len() * k);
    for t in 0..track.x.len() {
        features.advance(t);
        out.extend_from_slice(features.at(t));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::{
        Assembly, BorderColumn, Clock, EquationColumn, Resting, Transition, TransitionLaw,
    };
    use crate::campaign::{Criterion, Track};
    use crate::testing::small_campaign;

    /// Central differences of half the sum of squares.
    fn gradient_is_the_slope(normal: &Normal, p: &Linear, half_sum: impl Fn(&Linear) -> f64) {
        for i in 0..p.len() {
            let mut by = vec![0.0; p.len()];
            by[i] = 1.0;
            let h = 1e-5;
            let slope = (half_sum(&p.moved(&by, h)) - half_sum(&p.moved(&by, -h))) / (2.0 * h);
            let scale = normal.entry(i, i).max(1.0);
            assert!((slope - normal.gradient[i]).abs() < 1e-6 * scale, "{i}: {slope} {}", normal.gradient[i]);
        }
    }

    /// The oracle of the Jacobian under one step.
    fn check(assembly: &Assembly, p: &Linear) {
        let (campaign, grid) = small_campaign();
        let design = Design::new(&campaign, &grid, assembly, Track::is_fit);
        // Without output noise the whitening filter does not depend on the parameters.
        let whitener = Whitener::new(&assembly.noise, &p.a);
        let half_sum =
            |p: &Linear| 0.5 * design.innovations(p, &whitener).iter().flatten().map(|w| w * w).sum::<f64>();
        let innovations = design.innovations(p, &whitener).concat();
        let normal = Jacobian::new(&design, p, &whitener, None).normal(&innovations, &[]);
        gradient_is_the_slope(&normal, p, half_sum);
    }

    #[test]
    fn the_jacobian_of_a_simulation_agrees_with_differences() {
        let (campaign, grid) = small_campaign();
        let campaign = campaign.judged_by(Criterion::Simulation { share: 1.0 });
        let f: Vec<f64> = (0..grid.len()).map(|i| (i as f64 * 0.7).sin()).collect();
        let p = Linear { a: vec![-0.9, 0.3], b: vec![0.8, 0.3], f, d: Vec::new() };
        let design = Design::new(&campaign, &grid, &Assembly::default(), Track::is_fit);
        // Here the filter 1/A moves with the parameters.
        let errors = |p: &Linear| {
            let whitener = design.whitener(&Assembly::default().noise, &p.a);
            design.innovations(p, &whitener).concat()
        };
        let half_sum = |p: &Linear| 0.5 * errors(p).iter().map(|w| w * w).sum::<f64>();
        let whitener = design.whitener(&Assembly::default().noise, &p.a);
        let normal = Jacobian::new(&design, &p, &whitener, None).normal(&errors(&p), &[]);
        gradient_is_the_slope(&normal, &p, half_sum);
    }

    /// The oracle of the sparse rows: the dense ones.
    fn same_as_dense(assembly: &Assembly, p: &Linear) {
        let (campaign, grid) = small_campaign();
        let design = Design::new(&campaign, &grid, assembly, Track::is_fit);
        let whitener = Whitener::new(&assembly.noise, &p.a);
        let weights: Vec<Vec<f64>> = design
            .tracks
            .iter()
            .map(|t| (t.from..t.x.len()).map(|t| 0.5 + 0.1 * (t % 7) as f64).collect())
            .collect();
        let w = design.innovations(p, &whitener).concat();
        let sparse = Jacobian::new(&design, p, &whitener, Some(&weights)).normal(&w, &[]);
        let mut rows = Vec::new();
        for (track, weights) in design.tracks.iter().zip(&weights) {
            dense_rows(&mut rows, (&design, track), p, &whitener, Some(weights));
        }
        let dense = Jacobian { columns: p.len(), store: Store::Dense(rows) }.normal(&w, &[]);
        for i in 0..p.len() {
            assert!((sparse.gradient[i] - dense.gradient[i]).abs() < 1e-10);
            for j in i..p.len() {
                assert!((sparse.entry(i, j) - dense.entry(i, j)).abs() < 1e-10, "{i} {j}");
            }
        }
    }

    #[test]
    fn the_jacobian_agrees_with_differences() {
        let (_, grid) = small_campaign();
        let f: Vec<f64> = (0..grid.len()).map(|i| (i as f64 * 0.7).sin()).collect();
        let plain = Linear { a: vec![-0.6, 0.2], b: vec![0.8, 0.3], f, d: Vec::new() };
        check(&Assembly::default(), &plain);

        let mut assembly = Assembly {
            delay: 1.4,
            transition: Some(Transition { length: 0.1, shape: 1.2, law: TransitionLaw::Offset }),
            border_columns: vec![BorderColumn::Speed {
                power: 1.0,
                scale: 0.1,
                while_resting: Resting::Held,
            }],
            equation_columns: vec![EquationColumn::Trend { clock: Clock::Record, degree: 1 }],
            ..Assembly::default()
        };
        assembly.noise.ar = vec![0.3, -0.2];
        let mut rich = plain;
        rich.f.push(0.3);
        rich.d.push(0.1);
        check(&assembly, &rich);
        same_as_dense(&assembly, &rich);

        assembly.filter(&[0.5], &[1.0, -0.5]);
        assembly.noise.ma = vec![-0.4];
        check(&assembly, &rich);
    }
}
