//! Refined instrumental variables on the folds, eight replicates abreast: see `super::super::instrumental`.

use super::factor::{Factor, dot};
use super::method::{LaneFit, LaneSample};
use super::sized::{SizedWork, run_with_constant};
use super::statistics::LaneStatistics;
use crate::estimators::pulse::data::PulseData;
use crate::estimators::pulse::experiments::{first_level_value, satellite_value};
use crate::estimators::pulse::instrumental::STEPS;
use crate::lanes::{LANES, Lane, keep_apart};
use std::f64::consts::TAU;

/// A pivot that keeps less than this share of its diagonal entry leaves the replicate to the solver that goes one by one.
const SOUND: f64 = 1e-12;

/// All that is the same in every replicate, for experiments whose levels are visited once a period each, at the same phases in both.
///
/// The normal equations have three parts: the core `(a, b, o)`, and the levels of each experiment. A level's column is the response
/// to one pulse, so that two levels have in common what depends on their distance in time only, in both experiments alike; one
/// factor of that matrix eliminates the levels of both. What a level and a lag of the core have in common depends on their distance, too:
///
/// ```text
/// ψ_aᵢ = α e^{−jωi},  ψ_bᵢ = β e^{−jωi},  ψ_j = H e^{−jωτ_j},   H = B/A,  α = −H U/A,  β = U/A
/// ```
///
/// `O(T m n)` a step beside the `O(m³)` of that factor, not `O(T m²)`.
#[derive(Debug, Clone)]
pub(super) struct LaneFolds {
    period: usize,
    /// `w` at the satellite and at `V₁`, one entry an experiment.
    ends: Vec<[f64; 2]>,
    /// Phase of each level.
    phases: Vec<usize>,
    /// `cos` and `sin` of `ω_k p`, `T` a line.
    turns: Vec<[f64; 2]>,
    /// The distances in time between two levels, `V₁` apart.
    gaps: Vec<usize>,
    /// Which of them lies between any two, rows first.
    gap_of: Vec<usize>,
    /// Where the regression of the start has its rows: the phases whose lag window saw no level but `V₁`, each with the lag at which it did.
    known: Vec<(usize, Option<usize>)>,
}

/// Memory that is used again and again.
#[derive(Debug, Clone, Default)]
pub(super) struct FoldWork {
    colour: Vec<Lane>,
    mirrored: Vec<Lane>,
    /// `2K/(T S v⁻¹)` of each line, or half of it where it is its own mirror image.
    weights: Vec<Lane>,
    /// `Ȳ_k`, experiment by experiment.
    outputs: Vec<[Lane; 2]>,
    /// `P H*` times `α`, `β` and the residual of each line, experiment by experiment.
    crosses: Vec<[[Lane; 2]; 3]>,
    /// `w` of every level, experiment by experiment.
    levels: Vec<Lane>,
    gaps: Vec<Lane>,
    /// The factor of what the levels have in common, the inverse pivots on the diagonal.
    factor: Vec<Lane>,
    /// What each level has in common with the core and with the residual, `D + 1` a level.
    rows: Vec<Lane>,
    /// The column of an inverse.
    column: Vec<Lane>,
}

impl LaneFolds {
    /// `None` where the experiments are no pair that the lanes know.
    pub(super) fn of(experiments: &[&PulseData]) -> Option<Self> {
        let order = experiments[0].order();
        let folds = experiments.iter().map(|data| data.folds.as_ref()).collect::<Option<Vec<_>>>()?;
        let visits = &folds[0].visits;
        if folds.iter().any(|other| other.visits != *visits) {
            return None;
        }
        let points = experiments[0].points();
        let at = |level: usize| {
            let mut at = (0..visits.len()).filter(|p| visits[*p] == Some(level));
            at.next().filter(|_| at.next().is_none())
        };
        let phases = (0..points).map(at).collect::<Option<Vec<_>>>()?;
        let period = visits.len();
        let turn = |(k, p): (usize, usize)| {
            let (sin, cos) = (TAU * ((k * p) % period) as f64 / period as f64).sin_cos();
            [cos, sin]
        };
        let lines = period / 2 + 1;
        let gap = |i: usize, j: usize| {
            let apart = phases[i].abs_diff(phases[j]);
            apart.min(period - apart)
        };
        let pairs: Vec<usize> =
            (1..points).flat_map(|i| (1..points).map(move |j| (i, j))).map(|(i, j)| gap(i, j)).collect();
        let mut gaps = pairs.clone();
        gaps.sort_unstable();
        gaps.dedup();
        let place = |gap: &usize| gaps.binary_search(gap).unwrap_or_default();
        let seen = |p: usize| {
            let back = |lag: usize| visits[(p + period * lag - lag) % period];
            (1..=order).find_map(|lag| Some((back(lag)?, lag)))
        };
        let known = (0..period).filter_map(|p| match seen(p) {
            None => Some((p, None)),
            Some((0, lag)) => Some((p, Some(lag))),
            Some(_) => None,
        });
        Some(Self {
            known: known.collect(),
            turns: (0..lines).flat_map(|k| (0..period).map(move |p| (k, p))).map(turn).collect(),
            gap_of: pairs.iter().map(place).collect(),
            ends: experiments
                .iter()
                .map(|d| [satellite_value(d.branch), first_level_value(d.branch)])
                .collect(),
            period,
            phases,
            gaps,
        })
    }

    /// The estimates from a sample; nothing where the order is not compiled.
    pub(super) fn fit(&self, order: usize, sample: &LaneSample<'_>, fit: &mut LaneFit) {
        if !run_with_constant(order, Fold { folds: self, sample, fit }) {
            fit.sound = [false; LANES];
        }
    }
}

/// [`LaneFolds::fit`] on its way.
struct Fold<'a> {
    folds: &'a LaneFolds,
    sample: &'a LaneSample<'a>,
    fit: &'a mut LaneFit,
}

impl SizedWork for Fold<'_> {
    #[inline(always)]
    fn run<const N: usize, const D: usize>(self) {
        let Self { folds, sample, fit } = self;
        folds.solve::<N, D>(sample.parts, fit);
    }
}

/// `x·y`.
#[inline(always)]
fn times(x: [Lane; 2], y: [Lane; 2]) -> [Lane; 2] {
    [x[0] * y[0] - x[1] * y[1], x[0] * y[1] + x[1] * y[0]]
}

/// `x*·y`.
#[inline(always)]
fn conj_times(x: [Lane; 2], y: [Lane; 2]) -> [Lane; 2] {
    [x[0] * y[0] + x[1] * y[1], x[0] * y[1] - x[1] * y[0]]
}

/// `Re(x e^{jφ})`, given `cos φ` and `sin φ`.
#[inline(always)]
fn turned(x: [Lane; 2], [cos, sin]: [f64; 2]) -> Lane {
    x[0] * cos - x[1] * sin
}

impl LaneFolds {
    fn lines(&self) -> usize {
        self.period / 2 + 1
    }

    /// `p − lag` in the period.
    #[inline(always)]
    fn before(&self, p: usize, lag: usize) -> usize {
        let lag = lag % self.period;
        if p >= lag { p - lag } else { p + self.period - lag }
    }

    #[inline(always)]
    fn solve<const N: usize, const D: usize>(&self, parts: &[&LaneStatistics], fit: &mut LaneFit) {
        let LaneFit { values, variances, sound, folded: work, .. } = fit;
        *sound = [parts.iter().all(|part| part.samples == parts[0].samples); LANES];
        let variance = self.weigh(parts, work, sound);
        self.transform(parts, work);
        let mut theta = self.start::<N, D>(parts, work, sound);
        // Every call is compiled anew: a first round before the loop would double its code.
        let mut steps = 0;
        let factor = loop {
            let factor = self.step::<N, D>(&mut theta, work, sound);
            steps += 1;
            if steps == STEPS {
                break factor;
            }
        };
        self.read::<N, D>(&theta, (&factor, variance), work, (values, variances));
        let mut spoilt = Lane::ZERO;
        for (value, variance) in values.iter().zip(&*variances) {
            keep_apart();
            spoilt += (*value + *variance) * 0.0;
        }
        for l in 0..LANES {
            sound[l] &= spoilt.0[l] == 0.0;
        }
    }

    /// The weights of the lines by Levinson's recursion; the variance of the autoregression's source.
    #[inline(always)]
    fn weigh(&self, parts: &[&LaneStatistics], work: &mut FoldWork, sound: &mut [bool; LANES]) -> Lane {
        let FoldWork { colour, mirrored, weights, .. } = work;
        let period = self.period as f64;
        let freedom: f64 = parts.iter().map(|part| part.samples - period).sum();
        let lags = parts[0].left.len();
        for l in 0..LANES {
            sound[l] &= parts[0].samples >= 2.0 * period && lags > 0;
        }
        let gamma = |k: usize| {
            let mut sum = Lane::ZERO;
            for part in parts {
                sum += part.left[k];
            }
            sum * (1.0 / freedom)
        };
        colour.clear();
        let mut variance = if lags > 0 { gamma(0) } else { Lane::ZERO };
        for k in 1..lags {
            let mut ahead = gamma(k);
            for (i, d) in colour.iter().enumerate() {
                keep_apart();
                ahead += *d * gamma(k - 1 - i);
            }
            let reflection = Lane::ZERO - ahead / variance;
            for l in 0..LANES {
                sound[l] &= reflection.0[l].abs() < 1.0;
            }
            mirrored.clear();
            mirrored.extend(colour.iter().rev());
            for (d, m) in colour.iter_mut().zip(&*mirrored) {
                keep_apart();
                *d += reflection * *m;
            }
            colour.push(reflection);
            variance = variance * (Lane::splat(1.0) - reflection * reflection);
        }
        // |D|² = r₀ + 2 Σ r_j cos jω, r the autoproducts of (1, d₁, …).
        let coefficient = |i: usize| if i == 0 { Lane::splat(1.0) } else { colour[i - 1] };
        let length = colour.len() + 1;
        mirrored.clear();
        for j in 0..length {
            let mut sum = Lane::ZERO;
            for i in 0..length - j {
                keep_apart();
                sum += coefficient(i) * coefficient(i + j);
            }
            mirrored.push(if j == 0 { sum } else { sum + sum });
        }
        let scale = parts[0].samples / (period * period);
        weights.clear();
        for k in 0..self.lines() {
            let turns = &self.turns[k * self.period..(k + 1) * self.period];
            let mut power = Lane::ZERO;
            for (j, r) in mirrored.iter().enumerate() {
                keep_apart();
                power += *r * turns[j % self.period][0];
            }
            let alone = k == 0 || 2 * k == self.period;
            weights.push(power * if alone { scale } else { 2.0 * scale });
        }
        variance
    }

    /// The lines of the means.
    #[inline(always)]
    fn transform(&self, parts: &[&LaneStatistics], work: &mut FoldWork) {
        work.outputs.clear();
        for part in parts {
            for turns in self.turns.chunks_exact(self.period) {
                let mut line = [Lane::ZERO; 2];
                for (mean, &[cos, sin]) in part.folds.iter().zip(turns) {
                    keep_apart();
                    line[0] += *mean * cos;
                    line[1] -= *mean * sin;
                }
                work.outputs.push(line);
            }
        }
    }

    /// The parameters `(a, b, o)` and the levels by `joint`'s regression on one period of the means.
    #[inline(always)]
    fn start<const N: usize, const D: usize>(
        &self,
        parts: &[&LaneStatistics],
        work: &mut FoldWork,
        sound: &mut [bool; LANES],
    ) -> [Lane; D] {
        let (mut normal, mut right) = ([[Lane::ZERO; D]; D], [Lane::ZERO; D]);
        for (part, &[rest, first]) in parts.iter().zip(&self.ends) {
            for &(p, lag) in &self.known {
                keep_apart();
                let mut row = [Lane::splat(1.0); D];
                for i in 0..N {
                    row[i] = Lane::ZERO - part.folds[self.before(p, i + 1)];
                    row[N + i] = Lane::splat(if lag == Some(i + 1) { first } else { rest });
                }
                for i in 0..D {
                    right[i] += row[i] * part.folds[p];
                    for l in 0..D {
                        if l <= i {
                            normal[i][l] += row[i] * row[l];
                        }
                    }
                }
            }
        }
        let (factor, solved) = Factor::new(&normal);
        let mut theta = factor.solve(&right);
        let (mut a_at_one, mut norm) = (Lane::splat(1.0), Lane::ZERO);
        for i in 0..N {
            a_at_one += theta[i];
            norm += theta[N + i] * theta[N + i];
        }
        let constant = theta[2 * N];
        let inverse = Lane::splat(1.0) / norm;
        work.levels.clear();
        for (part, &[rest, first]) in parts.iter().zip(&self.ends) {
            work.levels.push(Lane::splat(first));
            for &phase in &self.phases[1..] {
                let mut inner = Lane::ZERO;
                for lag in 1..=N {
                    keep_apart();
                    // The mean with the level at this lag, less all of it but the level's own pulse.
                    let at = (phase + lag) % self.period;
                    let mut pulse = part.folds[at] - constant;
                    for i in 1..=N {
                        pulse += theta[i - 1] * part.folds[self.before(at, i)] - theta[N + i - 1] * rest;
                    }
                    inner += theta[N + lag - 1] * pulse;
                }
                work.levels.push(inner * inverse + Lane::splat(rest));
            }
        }
        theta[2 * N] = constant / a_at_one;
        for l in 0..LANES {
            sound[l] &= solved[l];
        }
        theta
    }

    /// One Gauss–Newton step; the factor of the core's information, the levels eliminated. [`FoldWork::rows`] keeps `L⁻¹C`.
    #[inline(always)]
    fn step<const N: usize, const D: usize>(
        &self,
        theta: &mut [Lane; D],
        work: &mut FoldWork,
        sound: &mut [bool; LANES],
    ) -> Factor<D> {
        let (mut normal, mut right) = self.lay_out::<N, D>(theta, work);
        self.factor_levels(work, sound);
        let inner = self.phases.len() - 1;
        let FoldWork { factor, rows, levels, .. } = work;
        for rows in rows.chunks_exact_mut((inner * (D + 1)).max(1)) {
            for j in 0..inner {
                let (before, row) = rows.split_at_mut(j * (D + 1));
                let row = &mut row[..D + 1];
                for (other, l) in before.chunks_exact(D + 1).zip(&factor[j * inner..j * inner + j]) {
                    keep_apart();
                    for d in 0..D + 1 {
                        row[d] -= *l * other[d];
                    }
                }
                for d in 0..D + 1 {
                    row[d] = row[d] * factor[j * inner + j];
                }
                for i in 0..D {
                    right[i] -= row[i] * row[D];
                    for l in 0..D {
                        if l <= i {
                            normal[i][l] -= row[i] * row[l];
                        }
                    }
                }
            }
        }
        let (core, solved) = Factor::new(&normal);
        let change = core.solve(&right);
        let points = inner + 1;
        for (rows, levels) in
            rows.chunks_exact_mut((inner * (D + 1)).max(1)).zip(levels.chunks_exact_mut(points))
        {
            for j in (0..inner).rev() {
                let mut x = rows[j * (D + 1) + D];
                for d in 0..D {
                    x -= rows[j * (D + 1) + d] * change[d];
                }
                for l in j + 1..inner {
                    keep_apart();
                    x -= factor[l * inner + j] * rows[l * (D + 1) + D];
                }
                let x = x * factor[j * inner + j];
                rows[j * (D + 1) + D] = x;
                levels[j + 1] += x;
            }
        }
        for d in 0..D {
            theta[d] += change[d];
        }
        for l in 0..LANES {
            sound[l] &= solved[l];
        }
        core
    }

    /// The normal equations of the core, before the levels are eliminated; what the levels have in common with it, and with each other.
    #[inline(always)]
    fn lay_out<const N: usize, const D: usize>(
        &self,
        theta: &[Lane; D],
        work: &mut FoldWork,
    ) -> ([[Lane; D]; D], [Lane; D]) {
        let FoldWork { weights, outputs, crosses, levels, gaps, rows, .. } = work;
        let (lines, points) = (self.lines(), self.phases.len());
        let period = self.period as f64;
        let one = Lane::splat(1.0);
        let (mut aa, mut bb) = ([Lane::ZERO; N], [Lane::ZERO; N]);
        let (mut ahead, mut behind) = ([Lane::ZERO; N], [Lane::ZERO; N]);
        let (mut normal, mut right) = ([[Lane::ZERO; D]; D], [Lane::ZERO; D]);
        crosses.clear();
        crosses.resize(self.ends.len() * lines, [[Lane::ZERO; 2]; 3]);
        gaps.clear();
        gaps.resize(self.gaps.len(), Lane::ZERO);
        let mut level_at_rest = Lane::ZERO;
        for k in 0..lines {
            keep_apart();
            let turns = &self.turns[k * self.period..(k + 1) * self.period];
            let (mut a, mut b) = ([one, Lane::ZERO], [Lane::ZERO; 2]);
            for i in 0..N {
                let [cos, sin] = turns[(i + 1) % self.period];
                a[0] += theta[i] * cos;
                a[1] -= theta[i] * sin;
                b[0] += theta[N + i] * cos;
                b[1] -= theta[N + i] * sin;
            }
            let inverse = one / (a[0] * a[0] + a[1] * a[1]);
            let a_inverse = [a[0] * inverse, Lane::ZERO - a[1] * inverse];
            let gain = times(b, a_inverse);
            let weight = weights[k];
            let weighted = [gain[0] * weight, gain[1] * weight];
            let power = weighted[0] * gain[0] + weighted[1] * gain[1];
            for (sum, gap) in gaps.iter_mut().zip(&self.gaps) {
                keep_apart();
                *sum += power * turns[*gap][0];
            }
            if k == 0 {
                level_at_rest = weighted[0] * period;
            }
            for (e, &[rest, _]) in self.ends.iter().enumerate() {
                keep_apart();
                let mut u = [Lane::splat(if k == 0 { period * rest } else { 0.0 }), Lane::ZERO];
                for (level, phase) in levels[e * points..(e + 1) * points].iter().zip(&self.phases) {
                    keep_apart();
                    let [cos, sin] = turns[*phase];
                    let pulse = *level - Lane::splat(rest);
                    u[0] += pulse * cos;
                    u[1] -= pulse * sin;
                }
                let z = times(gain, u);
                let output = outputs[e * lines + k];
                let mut left = [output[0] - z[0], output[1] - z[1]];
                let beta = times(u, a_inverse);
                let alpha = times(z, a_inverse);
                let alpha = [Lane::ZERO - alpha[0], Lane::ZERO - alpha[1]];
                let (alpha_weighted, beta_weighted) =
                    ([alpha[0] * weight, alpha[1] * weight], [beta[0] * weight, beta[1] * weight]);
                if k == 0 {
                    left[0] -= theta[2 * N] * period;
                    for i in 0..N {
                        normal[2 * N][i] += alpha_weighted[0] * period;
                        normal[2 * N][N + i] += beta_weighted[0] * period;
                    }
                    normal[2 * N][2 * N] += weight * (period * period);
                    right[2 * N] += weight * left[0] * period;
                }
                let alphas = alpha_weighted[0] * alpha[0] + alpha_weighted[1] * alpha[1];
                let betas = beta_weighted[0] * beta[0] + beta_weighted[1] * beta[1];
                let both = conj_times(alpha_weighted, beta);
                let (of_a, of_b) = (conj_times(alpha_weighted, left), conj_times(beta_weighted, left));
                for i in 0..N {
                    let [cos, sin] = turns[i % self.period];
                    aa[i] += alphas * cos;
                    bb[i] += betas * cos;
                    ahead[i] += turned(both, [cos, sin]);
                    behind[i] += turned(both, [cos, -sin]);
                    let next = turns[(i + 1) % self.period];
                    right[i] += turned(of_a, next);
                    right[N + i] += turned(of_b, next);
                }
                crosses[e * lines + k] =
                    [conj_times(weighted, alpha), conj_times(weighted, beta), conj_times(weighted, left)];
            }
        }
        for i in 0..N {
            for l in 0..N {
                if l <= i {
                    normal[i][l] = aa[i - l];
                    normal[N + i][N + l] = bb[i - l];
                }
                // The entry of b_i and a_l.
                normal[N + i][l] = if l >= i { ahead[l - i] } else { behind[i - l] };
            }
        }
        rows.clear();
        for crosses in crosses.chunks_exact(lines) {
            for &phase in &self.phases[1..] {
                let (mut of_a, mut of_b, mut of_left) = ([Lane::ZERO; N], [Lane::ZERO; N], Lane::ZERO);
                let mut places = [0; N];
                for i in 0..N {
                    places[i] = self.before(phase, i + 1);
                }
                for (cross, turns) in crosses.iter().zip(self.turns.chunks_exact(self.period)) {
                    keep_apart();
                    for i in 0..N {
                        of_a[i] += turned(cross[0], turns[places[i]]);
                        of_b[i] += turned(cross[1], turns[places[i]]);
                    }
                    of_left += turned(cross[2], turns[phase]);
                }
                rows.extend(of_a);
                rows.extend(of_b);
                rows.extend([level_at_rest, of_left]);
            }
        }
        (normal, right)
    }

    /// Cholesky's factor of what the levels of one experiment have in common.
    #[inline(always)]
    fn factor_levels(&self, work: &mut FoldWork, sound: &mut [bool; LANES]) {
        let inner = self.phases.len() - 1;
        let FoldWork { gaps, factor, .. } = work;
        factor.clear();
        factor.extend(self.gap_of.iter().map(|gap| gaps[*gap]));
        for j in 0..inner {
            let (row, below) = factor[j * inner..].split_at_mut(inner);
            let before = row[j];
            let mut pivot = before;
            for x in &row[..j] {
                keep_apart();
                pivot -= *x * *x;
            }
            for l in 0..LANES {
                sound[l] &= pivot.0[l] > SOUND * before.0[l];
            }
            let inverse = Lane::splat(1.0) / pivot.sqrt();
            row[j] = inverse;
            for other in below.chunks_exact_mut(inner) {
                let mut x = other[j];
                for (y, z) in other[..j].iter().zip(&row[..j]) {
                    keep_apart();
                    x -= *y * *z;
                }
                other[j] = x * inverse;
            }
        }
    }

    /// The parameters and their variances at the end.
    #[inline(always)]
    fn read<const N: usize, const D: usize>(
        &self,
        theta: &[Lane; D],
        (core, variance): (&Factor<D>, Lane),
        work: &mut FoldWork,
        (values, variances): (&mut Vec<Lane>, &mut Vec<Lane>),
    ) {
        let (mut a_at_one, mut b_at_one) = (Lane::splat(1.0), Lane::ZERO);
        for i in 0..N {
            a_at_one += theta[i];
            b_at_one += theta[N + i];
        }
        let inverse = Lane::splat(1.0) / b_at_one;
        let low = theta[2 * N] * a_at_one * inverse;
        let slopes = [theta[2 * N] * inverse, Lane::ZERO - low * inverse, a_at_one * inverse];
        let mut base = [Lane::ZERO; D];
        for d in 0..D {
            base[d] = slopes[d / N.max(1)];
        }
        base[2 * N] = slopes[2];
        values.clear();
        variances.clear();
        let diagonal = core.inverse_diagonal();
        for d in 0..2 * N {
            values.push(theta[d]);
            variances.push(variance * diagonal[d]);
        }
        let at_ends = {
            let solved = core.forward(&base);
            variance * dot(&solved, &solved)
        };
        let inner = self.phases.len() - 1;
        let FoldWork { factor, rows, levels, column, gaps, .. } = work;
        // The diagonal of the inverse of what the levels have in common, in the place of the gaps.
        gaps.clear();
        for j in 0..inner {
            column.clear();
            column.resize(inner, Lane::ZERO);
            let mut sum = Lane::ZERO;
            for i in j..inner {
                let mut x = if i == j { Lane::splat(1.0) } else { Lane::ZERO };
                for k in j..i {
                    keep_apart();
                    x -= factor[i * inner + k] * column[k];
                }
                column[i] = x * factor[i * inner + i];
                sum += column[i] * column[i];
            }
            gaps.push(sum);
        }
        for (e, levels) in levels.chunks_exact(inner + 1).enumerate() {
            values.push(low + levels[0]);
            variances.push(at_ends);
            let rows = &mut rows[e * inner * (D + 1)..(e + 1) * inner * (D + 1)];
            for j in (0..inner).rev() {
                let (row, below) = rows[j * (D + 1)..].split_at_mut(D + 1);
                for (other, i) in below.chunks_exact(D + 1).zip(j + 1..) {
                    keep_apart();
                    for d in 0..D {
                        row[d] -= factor[i * inner + j] * other[d];
                    }
                }
                for d in 0..D {
                    row[d] = row[d] * factor[j * inner + j];
                }
            }
            for (j, row) in rows.chunks_exact(D + 1).enumerate() {
                keep_apart();
                let mut gradient = base;
                for d in 0..D {
                    gradient[d] -= row[d];
                }
                let solved = core.forward(&gradient);
                values.push(low + levels[j + 1]);
                variances.push(variance * (gaps[j] + dot(&solved, &solved)));
            }
        }
    }
}
