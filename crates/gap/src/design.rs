//! From an assembly and the records to residuals and their derivatives.
//!
//! ```text
//! e(t) = x(t) + Σ aᵢ x(t−i) − Σ b̃ⱼ ũ(t−j) − Σ d ψ(t),   ũ = u / den,   b̃ = b ∗ taps,   u = rows · f
//! w(t) = s(t)·[e(t) + Σ dᵢ e(t−i)] − Σ cᵢ w(t−i)
//! ```
//!
//! `x` is the sensor's characteristic undone, `w` the innovation. Everything is linear given the effects' own parameters,
//! but for the product of `b` and `f`.

use crate::assembly::{Assembly, NoiseLaw, Saturation};
use crate::borders::Grid;
use crate::campaign::{Campaign, Track, WARM_UP};
use crate::normal::Normal;
use crate::rows::{Rows, equation_columns, rows, sensitivity_rows};

/// The parameters that are linear or bilinear given the effects' own.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Linear {
    pub(crate) a: Vec<f64>,
    pub(crate) b: Vec<f64>,
    /// Border values, then the coefficients of the border columns.
    pub(crate) f: Vec<f64>,
    /// Coefficients of the equation columns.
    pub(crate) d: Vec<f64>,
}

impl Linear {
    pub(crate) fn len(&self) -> usize {
        self.a.len() + self.b.len() + self.f.len() + self.d.len()
    }

    /// All parameters in one vector: a, b, f, d.
    pub(crate) fn flat(&self) -> Vec<f64> {
        [&self.a[..], &self.b, &self.f, &self.d].concat()
    }

    /// `self + step·by`.
    pub(crate) fn moved(&self, by: &[f64], step: f64) -> Self {
        let mut out = self.clone();
        let all = out.a.iter_mut().chain(&mut out.b).chain(&mut out.f).chain(&mut out.d);
        for (x, d) in all.zip(by) {
            *x += step * d;
        }
        out
    }

    /// The same system with `Σ b² = 1`: fixes the scale shared by `b` and `f`.
    pub(crate) fn gauged(mut self) -> Self {
        let norm = self.b.iter().map(|b| b * b).sum::<f64>().sqrt();
        if norm > 0.0 && norm.is_finite() {
            self.b.iter_mut().for_each(|b| *b /= norm);
            self.f.iter_mut().for_each(|f| *f *= norm);
        }
        self
    }
}

/// One track as the fit sees it.
#[derive(Debug, Clone)]
pub(crate) struct DesignTrack {
    pub(crate) rows: Rows,
    /// Equation columns, row-major.
    pub(crate) columns: Vec<f64>,
    /// The output with the sensor's characteristic undone.
    pub(crate) x: Vec<f64>,
    /// `ln dx/dy`, summed over the counted samples.
    pub(crate) log_slope: f64,
    /// First counted sample.
    pub(crate) from: usize,
    /// Change of `u` per change of `v` while moving and while resting, where input noise is modelled.
    pub(crate) sensitivity: Option<[Rows; 2]>,
    /// Samples whose output, or a lag of it, sits at a limit of the sensor; they are not counted.
    pub(crate) clipped: Option<Vec<bool>>,
}

/// The chosen tracks under an assembly.
#[derive(Debug, Clone)]
pub(crate) struct Design {
    pub(crate) tracks: Vec<DesignTrack>,
    pub(crate) taps: Vec<f64>,
    /// Denominator beyond its leading one.
    pub(crate) poles: Vec<f64>,
}

impl Design {
    /// Builds the design of the tracks that `chosen` picks.
    pub(crate) fn new(
        campaign: &Campaign,
        grid: &Grid,
        assembly: &Assembly,
        chosen: impl Fn(&Track) -> bool,
    ) -> Self {
        let numbered: Vec<(usize, &Track)> =
            campaign.tracks.iter().enumerate().filter(|(_, t)| chosen(t)).collect();
        Self::of(campaign, grid, assembly, &numbered)
    }

    /// Builds the design of tracks given with their numbers in the campaign.
    pub(crate) fn of(
        campaign: &Campaign,
        grid: &Grid,
        assembly: &Assembly,
        tracks: &[(usize, &Track)],
    ) -> Self {
        let tracks = tracks
            .iter()
            .map(|&(number, track)| {
                let (x, log_slope) = undo_sensor(track, assembly);
                DesignTrack {
                    rows: rows(campaign, track, grid, assembly),
                    columns: equation_columns(campaign, (number, track), assembly),
                    x,
                    log_slope,
                    from: track.from,
                    sensitivity: assembly
                        .noise
                        .input_ratio
                        .is_some()
                        .then(|| sensitivity_rows(campaign, track, grid)),
                    clipped: assembly.saturation.map(|limits| clipped(track, limits)),
                }
            })
            .collect();
        let poles = assembly.denominator.get(1..).map(<[f64]>::to_vec).unwrap_or_default();
        Self { tracks, taps: assembly.taps(), poles }
    }

    /// Samples counted.
    pub(crate) fn samples(&self) -> usize {
        self.tracks.iter().map(|t| t.x.len() - t.from).sum()
    }

    /// Sum of `ln dx/dy` over the counted samples.
    pub(crate) fn log_slope(&self) -> f64 {
        self.tracks.iter().map(|t| t.log_slope).sum()
    }

    /// `ũ` of one track.
    pub(crate) fn input(&self, track: &DesignTrack, f: &[f64]) -> Vec<f64> {
        let mut u: Vec<f64> = (0..track.x.len()).map(|t| track.rows.dot(t, f)).collect();
        if !self.poles.is_empty() {
            let rest = 1.0 / (1.0 + self.poles.iter().sum::<f64>());
            let before = u[0] * rest;
            for t in 0..u.len() {
                for (k, p) in self.poles.iter().enumerate() {
                    let past = if t > k { u[t - k - 1] } else { before };
                    u[t] -= p * past;
                }
            }
        }
        u
    }

    /// Equation errors `e(t)` of one track from sample `from − LEAD`.
    fn errors(&self, track: &DesignTrack, p: &Linear) -> Vec<f64> {
        let u = self.input(track, &p.f);
        let b = crate::assembly::convolve(&p.b, &self.taps);
        let m = p.d.len();
        (track.from.saturating_sub(LEAD)..track.x.len())
            .map(|t| {
                let mut e = track.x[t];
                for (i, a) in p.a.iter().enumerate() {
                    e += a * track.x[t.saturating_sub(i + 1)];
                }
                for (j, b) in b.iter().enumerate() {
                    e -= b * u[t.saturating_sub(j + 1)];
                }
                for (k, d) in p.d.iter().enumerate() {
                    e -= d * track.columns[t * m + k];
                }
                e
            })
            .collect()
    }

    /// Innovations of every track on the counted samples, before weighting.
    pub(crate) fn innovations(&self, p: &Linear, whitener: &Whitener) -> Vec<Vec<f64>> {
        self.tracks
            .iter()
            .map(|track| {
                let e = self.errors(track, p);
                let skip = track.from - track.from.saturating_sub(LEAD);
                let mut w = whitener.apply(&e);
                w.drain(..skip.min(w.len()));
                w
            })
            .collect()
    }

    /// Normal equations of the weighted innovations: columns a, b, f, d and those of `extra`.
    pub(crate) fn normal(&self, p: &Linear, whitener: &Whitener, around: &Around<'_>) -> Normal {
        let extra = around.extra.len();
        let size = p.len() + extra;
        let mut normal = Normal::new(size);
        for (number, track) in self.tracks.iter().enumerate() {
            let stream = JacobianStream::new(self, track, p);
            let first = track.from.saturating_sub(LEAD);
            let mut history = History::new(whitener, p.len());
            let mut row = vec![0.0; size];
            for t in first..track.x.len() {
                stream.row(t, &mut row[..p.len()]);
                history.whiten(&mut row[..p.len()]);
                if t < track.from {
                    continue;
                }
                let k = t - track.from;
                for (j, column) in around.extra.iter().enumerate() {
                    row[p.len() + j] = column[number][k];
                }
                let weight = around.weights.map_or(1.0, |s| s[number][k]);
                if weight == 0.0 {
                    continue;
                }
                if weight != 1.0 {
                    row.iter_mut().for_each(|x| *x *= weight);
                }
                normal.add(&row, around.innovations[number][k] * weight);
            }
        }
        normal
    }
}

/// What the normal equations are taken around.
pub(crate) struct Around<'a> {
    pub(crate) innovations: &'a [Vec<f64>],
    pub(crate) weights: Option<&'a [Vec<f64>]>,
    /// Derivatives of the innovations with respect to the effects' own parameters.
    pub(crate) extra: &'a [Vec<Vec<f64>>],
}

/// Samples before the first counted one that feed the whitening filter.
pub(crate) const LEAD: usize = 6;
const _: () = assert!(LEAD < WARM_UP);

/// Which counted samples have an output at a limit among those the equation needs.
fn clipped(track: &Track, limits: Saturation) -> Vec<bool> {
    let at: Vec<bool> = track.y.iter().map(|y| *y <= limits.low || *y >= limits.high).collect();
    (track.from..track.y.len()).map(|t| at[t - LEAD..=t].iter().any(|c| *c)).collect()
}

/// `x` of one track and its summed log slope.
fn undo_sensor(track: &Track, assembly: &Assembly) -> (Vec<f64>, f64) {
    let powers = &assembly.curve.powers;
    if powers.is_empty() {
        return (track.y.clone(), 0.0);
    }
    let mut log_slope = 0.0;
    let x = track
        .y
        .iter()
        .enumerate()
        .map(|(t, &y)| {
            let (mut value, mut slope, mut power) = (y, 1.0, y);
            for (k, c) in powers.iter().enumerate() {
                slope += c * (k + 2) as f64 * power;
                power *= y;
                value += c * power;
            }
            if t >= track.from {
                // A characteristic that folds back is no sensor: the floor makes it expensive, not undefined.
                log_slope += slope.max(1e-3).ln();
            }
            value
        })
        .collect();
    (x, log_slope)
}

/// The whitening filter `(1 + Σ dᵢq⁻ⁱ) / (1 + Σ cᵢq⁻ⁱ)`.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Whitener {
    ar: Vec<f64>,
    ma: Vec<f64>,
}

impl Whitener {
    /// The filter of a noise law at the given `A` (white output noise passes `A`).
    pub(crate) fn new(law: &NoiseLaw, a: &[f64]) -> Self {
        let mut ma = law.ma.clone();
        if law.output_ratio > 0.0 {
            ma = crate::spectral::factor_of_sum(law.output_ratio, a);
        }
        Self { ar: law.ar.clone(), ma }
    }

    /// The derivative of the innovations with respect to a coefficient of `g` added to `u`, from sample `from`.
    pub(crate) fn column(&self, g: &[f64], b: &[f64], from: usize) -> Vec<f64> {
        let first = from.saturating_sub(LEAD);
        let e: Vec<f64> = (first..g.len())
            .map(|t| -b.iter().enumerate().map(|(j, b)| b * g[t.saturating_sub(j + 1)]).sum::<f64>())
            .collect();
        let mut w = self.apply(&e);
        w.drain(..(from - first).min(w.len()));
        w
    }

    fn apply(&self, e: &[f64]) -> Vec<f64> {
        if self.ar.is_empty() && self.ma.is_empty() {
            return e.to_vec();
        }
        let mut w = Vec::with_capacity(e.len());
        for t in 0..e.len() {
            let mut now = e[t];
            for (i, d) in self.ar.iter().enumerate() {
                if t > i {
                    now += d * e[t - i - 1];
                }
            }
            for (i, c) in self.ma.iter().enumerate() {
                if t > i {
                    now -= c * w[t - i - 1];
                }
            }
            w.push(now);
        }
        w
    }
}

/// Rows of the Jacobian of `e`, one sample after the other.
struct JacobianStream<'a> {
    track: &'a DesignTrack,
    p: &'a Linear,
    b: Vec<f64>,
    /// `taps ∗ ũ`.
    tapped: Vec<f64>,
    /// Filtered rows, dense, row-major; empty without poles.
    dense: Vec<f64>,
}

impl<'a> JacobianStream<'a> {
    fn new(design: &'a Design, track: &'a DesignTrack, p: &'a Linear) -> Self {
        let u = design.input(track, &p.f);
        let tapped = if design.taps.len() == 1 && design.taps[0] == 1.0 {
            u
        } else {
            (0..u.len())
                .map(|t| design.taps.iter().enumerate().map(|(k, c)| c * u[t.saturating_sub(k)]).sum())
                .collect()
        };
        let dense =
            if design.poles.is_empty() { Vec::new() } else { filtered_rows(design, track, p.f.len()) };
        Self { track, p, b: crate::assembly::convolve(&p.b, &design.taps), tapped, dense }
    }

    fn row(&self, t: usize, row: &mut [f64]) {
        row.fill(0.0);
        let (na, nb, k) = (self.p.a.len(), self.p.b.len(), self.p.f.len());
        for i in 0..na {
            row[i] = self.track.x[t.saturating_sub(i + 1)];
        }
        for j in 0..nb {
            row[na + j] = -self.tapped[t.saturating_sub(j + 1)];
        }
        let borders = &mut row[na + nb..na + nb + k];
        for (j, b) in self.b.iter().enumerate() {
            let past = t.saturating_sub(j + 1);
            if self.dense.is_empty() {
                let (index, value) = self.track.rows.row(past);
                for (&i, x) in index.iter().zip(value) {
                    borders[i as usize] -= b * x;
                }
            } else {
                for (target, x) in borders.iter_mut().zip(&self.dense[past * k..(past + 1) * k]) {
                    *target -= b * x;
                }
            }
        }
        let m = self.p.d.len();
        for (target, psi) in row[na + nb + k..].iter_mut().zip(&self.track.columns[t * m..(t + 1) * m]) {
            *target = -psi;
        }
    }
}

/// Rows after the poles, dense, row-major, `k` a sample.
pub(crate) fn filtered_rows(design: &Design, track: &DesignTrack, k: usize) -> Vec<f64> {
    let n = track.x.len();
    let mut out = vec![0.0; n * k];
    let rest = 1.0 / (1.0 + design.poles.iter().sum::<f64>());
    let mut first = vec![0.0; k];
    let (index, value) = track.rows.row(0);
    for (&i, x) in index.iter().zip(value) {
        first[i as usize] += x * rest;
    }
    for t in 0..n {
        let (done, now) = out.split_at_mut(t * k);
        let now = &mut now[..k];
        let (index, value) = track.rows.row(t);
        for (&i, x) in index.iter().zip(value) {
            now[i as usize] += x;
        }
        for (lag, p) in design.poles.iter().enumerate() {
            let past = if t > lag { &done[(t - lag - 1) * k..(t - lag) * k] } else { &first };
            for (x, y) in now.iter_mut().zip(past) {
                *x -= p * y;
            }
        }
    }
    out
}

/// Past rows that the whitening filter needs.
struct History<'a> {
    whitener: &'a Whitener,
    raw: Vec<Vec<f64>>,
    white: Vec<Vec<f64>>,
}

impl<'a> History<'a> {
    fn new(whitener: &'a Whitener, size: usize) -> Self {
        Self {
            whitener,
            raw: vec![vec![0.0; size]; whitener.ar.len()],
            white: vec![vec![0.0; size]; whitener.ma.len()],
        }
    }

    fn whiten(&mut self, row: &mut [f64]) {
        if self.raw.is_empty() && self.white.is_empty() {
            return;
        }
        let before = (!self.raw.is_empty()).then(|| row.to_vec());
        for (d, past) in self.whitener.ar.iter().zip(&self.raw) {
            for (x, y) in row.iter_mut().zip(past) {
                *x += d * y;
            }
        }
        for (c, past) in self.whitener.ma.iter().zip(&self.white) {
            for (x, y) in row.iter_mut().zip(past) {
                *x -= c * y;
            }
        }
        if let Some(before) = before {
            self.raw.rotate_right(1);
            self.raw[0] = before;
        }
        if !self.white.is_empty() {
            self.white.rotate_right(1);
            self.white[0].copy_from_slice(row);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::{BorderColumn, Clock, EquationColumn, Resting, Transition, TransitionLaw};
    use crate::testing::small_campaign;

    /// The oracle of the Jacobian: central differences of half the sum of squares.
    fn check(assembly: &Assembly, p: &Linear) {
        let (campaign, grid) = small_campaign();
        let design = Design::new(&campaign, &grid, assembly, Track::is_fit);
        // Without output noise the whitening filter does not depend on the parameters.
        let whitener = Whitener::new(&assembly.noise, &p.a);
        let half_sum =
            |p: &Linear| 0.5 * design.innovations(p, &whitener).iter().flatten().map(|w| w * w).sum::<f64>();
        let innovations = design.innovations(p, &whitener);
        let around = Around { innovations: &innovations, weights: None, extra: &[] };
        let normal = design.normal(p, &whitener, &around);
        for i in 0..p.len() {
            let mut by = vec![0.0; p.len()];
            by[i] = 1.0;
            let h = 1e-5;
            let slope = (half_sum(&p.moved(&by, h)) - half_sum(&p.moved(&by, -h))) / (2.0 * h);
            let scale = normal.entry(i, i).max(1.0);
            assert!((slope - normal.gradient[i]).abs() < 1e-6 * scale, "{i}: {slope} {}", normal.gradient[i]);
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
        assembly.filter(&[0.5], &[1.0, -0.5]);
        assembly.noise.ar = vec![0.3];
        assembly.noise.ma = vec![-0.4];
        let mut rich = plain;
        rich.f.push(0.3);
        rich.d.push(0.1);
        check(&assembly, &rich);
    }
}
