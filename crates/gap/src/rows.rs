//! Border features: `u(t)` as a sparse combination of border values.

use std::f64::consts::PI;

use statrs::function::erf::erfc;

use crate::assembly::{Assembly, BorderColumn, Clock, EquationColumn, Resting, Slow, TransitionLaw};
use crate::borders::{Grid, side};
use crate::campaign::{Campaign, Criterion, Track};
use crate::motion::Motion;

/// Sparse rows, one a sample.
#[derive(Debug, Clone)]
pub(crate) struct Rows {
    start: Vec<u32>,
    index: Vec<u32>,
    value: Vec<f64>,
}

impl Rows {
    pub(crate) fn with_capacity(samples: usize) -> Self {
        let mut start = Vec::with_capacity(samples + 1);
        start.push(0);
        Self { start, index: Vec::with_capacity(2 * samples), value: Vec::with_capacity(2 * samples) }
    }

    pub(crate) fn push(&mut self, row: &[(u32, f64)], scale: f64) {
        for &(i, x) in row {
            if x != 0.0 {
                self.index.push(i);
                self.value.push(x * scale);
            }
        }
        self.start.push(self.index.len() as u32);
    }

    /// Non-zeros of row `t`.
    pub(crate) fn row(&self, t: usize) -> (&[u32], &[f64]) {
        let range = self.start[t] as usize..self.start[t + 1] as usize;
        (&self.index[range.clone()], &self.value[range])
    }

    /// `u(t)` for border values (and column coefficients) `f`.
    pub(crate) fn dot(&self, t: usize, f: &[f64]) -> f64 {
        let (index, value) = self.row(t);
        index.iter().zip(value).map(|(&i, x)| x * f[i as usize]).sum()
    }
}

/// Weight below which a fading border value is dropped from a row.
const NEGLIGIBLE: f64 = 1e-5;

/// The value of a clock at a sample.
pub(crate) fn clock(clock: Clock, campaign: &Campaign, track: &Track, t: usize, path: f64) -> f64 {
    match clock {
        Clock::Campaign => (track.clock + t) as f64 / campaign.total as f64,
        Clock::Record => t as f64 / track.v.len() as f64,
        Clock::Travel => (track.travelled + path) / campaign.travel,
    }
}

/// The rows of one track: first the border values of `grid`, then the assembly's border columns.
pub(crate) fn rows(
    (campaign, number, track): (&Campaign, usize, &Track),
    moves: &[Motion],
    grid: &Grid,
    assembly: &Assembly,
) -> Rows {
    let columns = grid.len() as u32;
    let mut out = Rows::with_capacity(track.v.len());
    let mut builder = Builder::new(grid, assembly, track.v[0], campaign.criterion);
    let own = |c: &BorderColumn| matches!(c, BorderColumn::Start { track } if *track == number);
    if let Some(start) = assembly.border_columns.iter().position(own) {
        builder.current.push((columns + start as u32, 1.0));
    }
    let mut held: Vec<f64> = vec![0.0; assembly.border_columns.len()];
    let mut row: Vec<(u32, f64)> = Vec::new();
    for (t, m) in moves.iter().enumerate() {
        let slow = |s: &Slow| s.at(clock(s.clock, campaign, track, t, m.path));
        if m.reversal {
            builder.turn(m);
        }
        if assembly.jitter > 0.0 {
            builder.jittered(ascending(m.step, assembly.jitter), track.v[t]);
        } else if m.moves {
            let narrowing = assembly.wear.as_ref().map_or(0.0, slow);
            builder.step(m, track.v[t], narrowing);
        }
        row.clear();
        row.extend_from_slice(&builder.current);
        for (j, column) in assembly.border_columns.iter().enumerate() {
            if let BorderColumn::Start { .. } = column {
                // Part of the working point.
                continue;
            }
            let s = match column {
                BorderColumn::BranchSlow { clock: c } | BorderColumn::SideSlow { clock: c, .. } => {
                    clock(*c, campaign, track, t, m.path)
                }
                _ => 0.0,
            };
            held[j] = column_value(column, m, s, held[j]);
            row.push((columns + j as u32, held[j]));
        }
        let gain = 1.0 + assembly.gain.as_ref().map_or(0.0, slow);
        out.push(&row, gain);
    }
    out
}

fn column_value(column: &BorderColumn, m: &Motion, s: f64, held: f64) -> f64 {
    let speed = m.step.abs();
    match *column {
        BorderColumn::Speed { power, scale, while_resting } => match (m.step == 0.0, while_resting) {
            (true, Resting::Held) => held,
            (true, Resting::Zero) => 0.0,
            _ => m.branch * (speed / scale).powf(power),
        },
        BorderColumn::LowSpeed { power, scale, while_resting } => match (m.step == 0.0, while_resting) {
            (true, Resting::Held) => held,
            (true, Resting::Zero) => m.branch,
            _ => m.branch * (-(speed / scale).powf(power)).exp(),
        },
        BorderColumn::RestingLog { scale } => m.branch * (m.rest as f64 / scale).ln_1p(),
        BorderColumn::ReversalLog { scale } => m.branch * (m.since as f64 / scale).ln_1p(),
        BorderColumn::RestingRise { scale } => -m.branch * (-(m.rest as f64) / scale).exp_m1(),
        BorderColumn::SideSlow { branch, .. } if m.moves => {
            if m.branch == branch {
                s
            } else {
                0.0
            }
        }
        BorderColumn::SideSlow { .. } | BorderColumn::Start { .. } => held,
        BorderColumn::BranchSlow { .. } => {
            if m.moves {
                m.branch * s
            } else {
                held
            }
        }
    }
}

/// Follows the working point.
struct Builder<'a> {
    grid: &'a Grid,
    assembly: &'a Assembly,
    current: Vec<(u32, f64)>,
    /// What fades during the present transition.
    fading: Vec<(u32, f64)>,
    scratch: Vec<f64>,
}

impl<'a> Builder<'a> {
    fn new(grid: &'a Grid, assembly: &'a Assembly, v: f64, criterion: Criterion) -> Self {
        // Before the first move u is unknown; the end of the stroke that v is nearer to tells the likelier border.
        let start = grid.hat(usize::from(v >= 0.5), v);
        let current = match criterion {
            Criterion::OneStep => start.iter().map(|&(i, w)| (i as u32, w)).collect(),
            // A simulation goes on from there for long: the middle between the borders is never far off.
            Criterion::Simulation { .. } => {
                [0, 1].iter().flat_map(|&s| grid.hat(s, v)).map(|(i, w)| (i as u32, 0.5 * w)).collect()
            }
        };
        Self {
            grid,
            assembly,
            current,
            fading: Vec::new(),
            scratch: vec![0.0; grid.len() + assembly.border_columns.len()],
        }
    }

    /// A reversal: notes what will fade.
    fn turn(&mut self, m: &Motion) {
        let Some(transition) = self.assembly.transition else { return };
        match transition.law {
            TransitionLaw::Held => self.fading.clone_from(&self.current),
            TransitionLaw::OldBorder => self.fading.clear(),
            TransitionLaw::Offset => {
                let mut terms = self.current.clone();
                for (i, w) in self.grid.hat(side(m.branch), m.turn) {
                    terms.push((i as u32, -w));
                }
                self.fading = self.merged(&terms);
            }
        }
    }

    /// A move on a border.
    fn step(&mut self, m: &Motion, v: f64, narrowing: f64) {
        let own = self.grid.hat(side(m.branch), v);
        let mut terms: Vec<(u32, f64)> = own.iter().map(|&(i, w)| (i as u32, w)).collect();
        if narrowing != 0.0 {
            let half = 0.5 * narrowing;
            terms.iter_mut().for_each(|(_, w)| *w *= 1.0 - half);
            terms.extend(self.grid.hat(side(-m.branch), v).iter().map(|&(i, w)| (i as u32, w * half)));
        }
        if let Some(transition) = self.assembly.transition {
            let fade = (-(m.travel / transition.length).powf(transition.shape)).exp();
            if fade > NEGLIGIBLE {
                match transition.law {
                    TransitionLaw::Offset => terms.extend(self.fading.iter().map(|&(i, w)| (i, w * fade))),
                    TransitionLaw::Held => {
                        terms.iter_mut().for_each(|(_, w)| *w *= 1.0 - fade);
                        terms.extend(self.fading.iter().map(|&(i, w)| (i, w * fade)));
                    }
                    TransitionLaw::OldBorder => {
                        terms.iter_mut().for_each(|(_, w)| *w *= 1.0 - fade);
                        let old = self.grid.hat(side(-m.branch), v);
                        terms.extend(old.iter().map(|&(i, w)| (i as u32, w * fade)));
                    }
                }
            }
        }
        self.current = if terms.len() > 2 { self.merged(&terms) } else { terms };
    }

    /// The mean over both borders where noise on the position decides the branch.
    fn jittered(&mut self, ascending: f64, v: f64) {
        let both = [(0, 1.0 - ascending), (1, ascending)];
        let terms = both.map(|(side, p)| self.grid.hat(side, v).map(|(i, w)| (i as u32, p * w)));
        self.current = terms.concat();
    }

    /// Sums repeated indices and drops negligible weights.
    fn merged(&mut self, terms: &[(u32, f64)]) -> Vec<(u32, f64)> {
        for &(i, w) in terms {
            self.scratch[i as usize] += w;
        }
        let mut out = Vec::with_capacity(terms.len());
        for &(i, _) in terms {
            let w = std::mem::take(&mut self.scratch[i as usize]);
            if w.abs() > NEGLIGIBLE {
                out.push((i, w));
            }
        }
        out
    }
}

/// Probability that the noisy position rises: `P(step + n₁ − n₀ > 0)`, both noises normal with standard deviation `jitter`.
fn ascending(step: f64, jitter: f64) -> f64 {
    0.5 * erfc(-0.5 * step / jitter)
}

/// How `u` answers to a small change of `v`, as rows: per unit of `v` while moving (over a fiftieth of the stroke, so
/// that a jump counts as a steep slope), and by a switch to the other border while resting, or at any
/// time where noise on the position of standard deviation `jitter` switches branches.
pub(crate) fn sensitivity_rows(track: &Track, grid: &Grid, jitter: f64) -> [Rows; 2] {
    const HALF: f64 = 0.01;
    let mut moving = Rows::with_capacity(track.v.len());
    let mut resting = Rows::with_capacity(track.v.len());
    for (m, &v) in track.moves.iter().zip(&track.v) {
        let mut slope = Vec::new();
        let mut gap = Vec::new();
        let own = side(m.branch);
        let spread = if jitter > 0.0 {
            let p = ascending(m.step, jitter);
            (p * (1.0 - p)).sqrt()
        } else {
            f64::from(u8::from(!m.moves))
        };
        if m.moves || jitter > 0.0 {
            slope.extend(grid.hat(own, v + HALF).map(|(i, w)| (i as u32, w / (2.0 * HALF))));
            slope.extend(grid.hat(own, v - HALF).map(|(i, w)| (i as u32, -w / (2.0 * HALF))));
        }
        if spread > 0.0 {
            gap.extend(grid.hat(1, v).map(|(i, w)| (i as u32, spread * w)));
            gap.extend(grid.hat(0, v).map(|(i, w)| (i as u32, -spread * w)));
        }
        moving.push(&slope, 1.0);
        resting.push(&gap, 1.0);
    }
    [moving, resting]
}

/// The equation columns of one track, row-major, `columns` a sample.
pub(crate) fn equation_columns(
    campaign: &Campaign,
    tracks: (usize, &Track),
    assembly: &Assembly,
) -> Vec<f64> {
    let (number, track) = tracks;
    let count = assembly.equation_columns.len();
    let mut out = vec![0.0; track.v.len() * count];
    for (j, column) in assembly.equation_columns.iter().enumerate() {
        let cells = out.iter_mut().skip(j).step_by(count);
        match *column {
            EquationColumn::Line { track: Some(only), .. }
            | EquationColumn::Decay { track: only, .. }
            | EquationColumn::Local { track: only, .. }
                if only != number => {}
            EquationColumn::Line { frequency, track: only, sine } => {
                let first = if only.is_some() { 0.0 } else { track.clock as f64 };
                let mut wave = Wave::starting(frequency, first);
                cells.for_each(|cell| *cell = wave.next(sine));
            }
            EquationColumn::Trend { clock: c, degree } => cells.enumerate().for_each(|(t, cell)| {
                let at = clock(c, campaign, track, t, track.moves[t].path);
                *cell = (2.0 * at - 1.0).powi(degree as i32);
            }),
            EquationColumn::Decay { radius, frequency, sine, .. } => {
                let mut wave = Wave::starting(frequency, 0.0);
                let mut size = 1.0;
                let from = track.from.min(6);
                for (t, cell) in cells.enumerate() {
                    let value = size * wave.next(sine);
                    *cell = if t < from { 0.0 } else { value };
                    size *= radius;
                    if size < 1e-9 {
                        break;
                    }
                }
            }
            EquationColumn::Local { piece, pieces, .. } => cells.enumerate().for_each(|(t, cell)| {
                let at = t as f64 / track.v.len() as f64 * pieces as f64;
                *cell = (1.0 - (at - piece as f64).abs()).max(0.0);
            }),
        }
    }
    out
}

/// A sinusoid sample by sample, by rotation; set anew every so often, so that rounding does not add up.
struct Wave {
    frequency: f64,
    at: f64,
    left: usize,
    turn: (f64, f64),
    now: (f64, f64),
}

impl Wave {
    /// Samples between exact values.
    const AFRESH: usize = 256;

    fn starting(frequency: f64, at: f64) -> Self {
        Self { frequency, at, left: 0, turn: frequency.sin_cos(), now: (0.0, 1.0) }
    }

    fn next(&mut self, sine: bool) -> f64 {
        if self.left == 0 {
            self.now = ((self.frequency * self.at) % (2.0 * PI)).sin_cos();
            self.left = Self::AFRESH;
        }
        let (s, c) = self.now;
        let (ds, dc) = self.turn;
        self.now = (s * dc + c * ds, c * dc - s * ds);
        self.left -= 1;
        self.at += 1.0;
        if sine { s } else { c }
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use statrs::distribution::{ContinuousCDF, Normal};

    use super::*;

    #[test]
    fn the_noisy_position_rises_as_often_as_draws_do() {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let normal = Normal::new(0.0, 0.02).unwrap();
        let mut draw = || normal.inverse_cdf(rng.random::<f64>());
        for step in [-0.05, -0.01, 0.0, 0.02] {
            let rises = (0..20_000).filter(|_| step + draw() - draw() > 0.0).count() as f64 / 20_000.0;
            // Four standard errors of a share.
            assert!((rises - ascending(step, 0.02)).abs() < 0.015, "{step}: {rises}");
        }
    }

    #[test]
    fn a_wave_by_rotation_is_the_wave() {
        let mut wave = Wave::starting(0.37, 1200.0);
        for t in 1200..3000 {
            let exact = (0.37 * f64::from(t)).sin();
            assert!((wave.next(true) - exact).abs() < 1e-11, "{t}");
        }
    }
}
