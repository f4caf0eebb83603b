//! The whole second-order term of the errors of eight replicates, with the first.

use super::sample::LaneSample;
use super::scratch::Scratch;
use super::statistics::LaneStatistics;
use super::terms::LaneTerms;
use crate::pulse::GroupedStatistics;
use crate::pulse::level_rule::LevelRule;
use crate::pulse::solution::{Base, Level, Solution};
use std::ops::Range;
use switchback_noise::lanes::{Lane, keep_apart};

/// [`Solution::second_order_term`] as algebra on lanes.
///
/// With `r̄_q` the mean residual of a group at the limit's parameters, `e_q` the deviation of its mean lags from their expectation `z̄_q`, and
/// `α` the first-order change of `a`, a group of `K` samples adds to the right-hand side of the second order on `a`
///
/// ```text
/// K e (r̄ − eᵀα)                                             a group with a mean of its own
/// K (e (m − z̄ᵀα) − (e + z̄) eᵀα) + G K eᵀα                 any other, whose mean moves by m
/// ```
///
/// `O(n)` a group with a mean of its own, which most have; `O(n + D)` any other, `D` the core's parameters.
#[derive(Debug, Clone)]
pub(crate) struct WholeControl {
    /// What the limit was taken about.
    reference: f64,
    /// The limit's `a`, and `A(1)`.
    a: Vec<f64>,
    a_at_one: f64,
    /// `y₀`, that is `ŷ₀` at the limit.
    step_mean: f64,
    groups: Vec<Group>,
    /// `z̄`, `n` a group.
    lags: Vec<f64>,
    /// `G`, one row a group.
    to_core: Vec<f64>,
    /// Shared columns of the groups, each row once.
    rows: Vec<f64>,
    /// Expectation of the lag products within the groups, `n × n`.
    within: Vec<f64>,
    /// The core's right-hand side for a constant left in the output.
    constant: Vec<f64>,
    /// Inverse of the core's normal matrix, the local columns eliminated.
    inverse: Vec<f64>,
    tied: Vec<Tied>,
    /// Groups and weights of the local columns over several groups, one after the other.
    support: Vec<(usize, f64)>,
    /// Their slopes, one row a column.
    slopes: Vec<f64>,
    bilinear: bool,
    base: Held,
    /// How each border point is read.
    rules: Vec<LevelRule>,
    /// The limit's local columns.
    local: Vec<f64>,
    /// The limit's `b`.
    b: Vec<f64>,
}

#[derive(Debug, Clone)]
struct Group {
    /// The limit's mean.
    mean: f64,
    /// Its row of [`WholeControl::rows`].
    row: usize,
    local: Local,
}

/// The local column of a group.
#[derive(Debug, Clone, Copy)]
enum Local {
    None,
    /// Its own mean.
    Alone(usize),
    /// One over several groups, seen here at a lag (from 0).
    Tied {
        local: usize,
        weight: f64,
        lag: usize,
    },
}

/// A local column over several groups.
#[derive(Debug, Clone)]
struct Tied {
    local: usize,
    /// Its entries of [`WholeControl::support`].
    entries: Range<usize>,
    /// `1/D`.
    inverse: f64,
}

/// The base of the levels `u/v`.
#[derive(Debug, Clone)]
struct Held {
    /// Its derivative in the core, and in `ŷ₀`.
    core: Vec<f64>,
    step: f64,
    u: f64,
    v: f64,
    /// The output at which it is held: the derivative of `u` in each of `a`.
    output: f64,
    /// Whether `u` holds the constant column.
    constant: bool,
}

impl WholeControl {
    pub(crate) fn of(solution: &Solution, expected: &GroupedStatistics) -> Self {
        let Solution { fit, columns, order: n, reference, .. } = solution;
        let n = *n;
        let mut local = vec![Local::None; columns.offset.len()];
        let (mut tied, mut support, mut slopes) = (Vec::new(), Vec::new(), Vec::new());
        for (l, (column, tie)) in columns.local.iter().zip(&fit.ties).enumerate() {
            if let &[(q, 1.0)] = column.support.as_slice() {
                local[q] = Local::Alone(l);
                continue;
            }
            let start = support.len();
            for (lag, &(q, weight)) in column.support.iter().enumerate() {
                local[q] = Local::Tied { local: l, weight, lag };
                support.push((q, weight));
            }
            slopes.extend(tie.slope.iter());
            tied.push(Tied { local: l, entries: start..support.len(), inverse: 1.0 / tie.own });
        }
        let mut rows: Vec<Vec<f64>> = Vec::new();
        let mut row_of = |q: usize| {
            let row: Vec<f64> = columns.shared.row(q).iter().copied().collect();
            rows.iter().position(|other| *other == row).unwrap_or_else(|| {
                rows.push(row);
                rows.len() - 1
            })
        };
        let means = fit.group_means(columns);
        let groups: Vec<Group> =
            (0..means.len()).map(|q| Group { mean: means[q], row: row_of(q), local: local[q] }).collect();
        let lag = |q: usize, i: usize| expected.sum(q, i + 1) / expected.count(q);
        let within = |k: usize| {
            let (i, l) = (k / n, k % n);
            let between = |q: usize| expected.count(q) * lag(q, i) * lag(q, l);
            expected.product(i + 1, l + 1) - (0..means.len()).map(between).sum::<f64>()
        };
        let counts: Vec<f64> = (0..means.len()).map(|q| expected.count(q)).collect();
        let totals: Vec<f64> = (1..=n).map(|i| -expected.total(i)).collect();
        let base = Base::of(fit, n, *reference, &solution.level);
        let a_at_one = 1.0 + fit.core.rows(0, n).sum();
        let v = fit.core.rows(n, n).sum();
        let (step_mean, output, constant) = match solution.level {
            Level::Constant => (0.0, *reference, true),
            Level::Step(step) => (step.mean, step.mean, false),
        };
        Self {
            reference: *reference,
            a: fit.core.rows(0, n).iter().copied().collect(),
            a_at_one,
            step_mean,
            lags: (0..means.len()).flat_map(|q| (0..n).map(move |i| lag(q, i))).collect(),
            to_core: fit.core_sides(columns, n),
            within: (0..n * n).map(within).collect(),
            constant: fit.core_side(columns, &counts, &totals).iter().copied().collect(),
            inverse: fit.factor.inverse().iter().copied().collect(),
            tied,
            support,
            slopes,
            bilinear: columns.bilinear,
            base: Held {
                core: base.core.iter().copied().collect(),
                step: base.step,
                u: base.value * v,
                v,
                output,
                constant,
            },
            rules: solution.rules().collect(),
            local: fit.local.clone(),
            b: fit.core.rows(n, n).iter().copied().collect(),
            rows: rows.concat(),
            groups,
        }
    }

    /// Lags and core parameters.
    pub(super) fn size(&self) -> (usize, usize) {
        (self.a.len(), self.constant.len())
    }

    /// The terms of one sample.
    #[inline(always)]
    pub(super) fn carry<const N: usize, const D: usize>(
        &self,
        sample: &LaneSample<'_>,
        LaneTerms { first, second, whole, .. }: &mut LaneTerms,
    ) {
        let delta = match sample.step {
            Some(step) => step.mean - Lane::splat(self.step_mean),
            None => Lane::ZERO,
        };
        whole.first.resize(self.local.len(), Lane::ZERO);
        whole.second.resize(self.local.len(), Lane::ZERO);
        let score = self.score::<N, D>(sample.parts, delta, &mut whole.residuals);
        let change = self.solve(&score);
        self.tied_first::<D>(sample.parts, &change, whole);
        self.multiply_rows::<N, D>(&change, &mut whole.rows);
        let stepped = sample.step.is_some();
        let right = self.second_side::<N, D>(sample.parts, (&change, delta, stepped), whole);
        let bent = self.solve(&right);
        self.multiply_rows::<N, D>(&bent, &mut whole.rows);
        self.locals_second::<N, D>(&bent, whole);
        self.read::<N, D>((&change, &bent, delta), whole, first, second);
    }

    /// The score on the core; and the mean residuals, `A(1)δ` taken off.
    #[inline(always)]
    fn score<const N: usize, const D: usize>(
        &self,
        parts: &[&LaneStatistics],
        delta: Lane,
        residuals: &mut Vec<Lane>,
    ) -> [Lane; D] {
        let reference = Lane::splat(self.reference);
        let a: &[f64; N] = self.a.first_chunk().expect("the order is that of the code that was chosen");
        let missing = delta * self.a_at_one;
        let mut core = [Lane::ZERO; D];
        residuals.resize(self.groups.len(), Lane::ZERO);
        let (lags, weights) = (self.lags.as_chunks::<N>().0, self.to_core.as_chunks::<D>().0);
        let mut constants = self.groups.iter().zip(lags).zip(weights).zip(&mut *residuals);
        for part in parts {
            let within = &part.within[..(N + 1) * (N + 1)];
            for i in 0..N {
                let row = (i + 1) * (N + 1);
                let mut sum = within[row];
                for l in 0..N {
                    sum += within[row + 1 + l] * a[l];
                }
                core[i] -= sum;
            }
            let groups = part.means.chunks_exact(N + 1).zip(&part.counts);
            for ((mean, &count), (((group, lags), weights), into)) in groups.zip(&mut constants) {
                keep_apart();
                let mut residual = mean[0] - reference - Lane::splat(group.mean);
                for l in 0..N {
                    residual += (mean[l + 1] - reference) * a[l];
                }
                let total = residual * count;
                let alone = matches!(group.local, Local::Alone(_));
                for i in 0..N {
                    let past = mean[i + 1] - reference;
                    let weight = if alone { lags[i] } else { weights[i] };
                    core[i] += (Lane::splat(weight) - past) * total;
                }
                if !alone {
                    for d in N..D {
                        core[d] += total * weights[d];
                    }
                }
                *into = residual - missing;
            }
        }
        for d in 0..D {
            core[d] -= missing * self.constant[d];
        }
        core
    }

    /// The core's change for a right-hand side.
    #[inline(always)]
    fn solve<const D: usize>(&self, right: &[Lane; D]) -> [Lane; D] {
        let mut change = [Lane::ZERO; D];
        for (change, row) in change.iter_mut().zip(self.inverse.as_chunks::<D>().0) {
            for d in 0..D {
                *change += right[d] * row[d];
            }
        }
        change
    }

    /// First order of the local columns over several groups.
    #[inline(always)]
    fn tied_first<const D: usize>(
        &self,
        parts: &[&LaneStatistics],
        change: &[Lane; D],
        scratch: &mut Scratch,
    ) {
        for (tied, slope) in self.tied.iter().zip(self.slopes.as_chunks::<D>().0) {
            keep_apart();
            let mut target = Lane::ZERO;
            for &(group, weight) in &self.support[tied.entries.clone()] {
                keep_apart();
                target += scratch.residuals[group] * (weight * count(parts, group));
            }
            let mut value = target * tied.inverse;
            for d in 0..D {
                value -= change[d] * slope[d];
            }
            scratch.first[tied.local] = value;
        }
    }

    /// What the shared columns make of a change of the core.
    #[inline(always)]
    fn multiply_rows<const N: usize, const D: usize>(&self, change: &[Lane; D], rows: &mut Vec<Lane>) {
        rows.clear();
        for row in self.rows.chunks_exact(D - N) {
            keep_apart();
            let mut sum = Lane::ZERO;
            for k in 0..D - N {
                sum += change[N + k] * row[k];
            }
            rows.push(sum);
        }
    }

    /// The right-hand side of the second order on the core, given the first; and what it is against each group.
    #[inline(always)]
    fn second_side<const N: usize, const D: usize>(
        &self,
        parts: &[&LaneStatistics],
        (change, delta, stepped): (&[Lane; D], Lane, bool),
        scratch: &mut Scratch,
    ) -> [Lane; D] {
        let Scratch { residuals, along, rows, first, second } = scratch;
        along.resize(self.groups.len(), Lane::ZERO);
        let mut right = [Lane::ZERO; D];
        let (mut noise, mut xi) = ([Lane::ZERO; N], Lane::ZERO);
        let mut of_a = Lane::ZERO;
        for i in 0..N {
            of_a += change[i];
            for l in 0..N {
                right[i] += change[l] * self.within[i * N + l];
            }
        }
        let shifted = delta * of_a;
        let (lags, weights) = (self.lags.as_chunks::<N>().0, self.to_core.as_chunks::<D>().0);
        let into = residuals.iter_mut().zip(&mut *along);
        let mut constants = self.groups.iter().zip(lags).zip(weights).zip(into);
        for part in parts {
            let within = &part.within[..(N + 1) * (N + 1)];
            for i in 0..N {
                for l in 0..N {
                    right[i] -= within[(i + 1) * (N + 1) + l + 1] * change[l];
                }
            }
            let groups = part.means.chunks_exact(N + 1).zip(&part.counts);
            for ((mean, &count), (((group, lags), weights), (residual, into))) in groups.zip(&mut constants) {
                keep_apart();
                let mut e = [Lane::ZERO; N];
                let (mut through, mut past) = (Lane::ZERO, Lane::ZERO);
                for i in 0..N {
                    e[i] = mean[i + 1] - Lane::splat(self.reference + lags[i]);
                    through += e[i] * change[i];
                    past += change[i] * lags[i];
                }
                if stepped {
                    xi += *residual * count;
                    for i in 0..N {
                        noise[i] += e[i] * count;
                    }
                }
                *into = through - shifted;
                match group.local {
                    Local::Alone(local) => {
                        first[local] = *residual + past - rows[group.row];
                        for i in 0..N {
                            right[i] += ((e[i] - delta) * *residual - e[i] * through) * count;
                        }
                    }
                    Local::None | Local::Tied { .. } => {
                        let mut moved = rows[group.row];
                        if let Local::Tied { local, weight, lag } = group.local {
                            moved += first[local] * weight;
                            if self.bilinear {
                                *into -= change[N + lag] * first[local];
                            }
                        }
                        let left = moved - past;
                        *residual -= left;
                        for i in 0..N {
                            let own = (e[i] - delta) * left - e[i] * through;
                            right[i] += (own + *into * (weights[i] - lags[i])) * count;
                        }
                        let total = *into * count;
                        for d in N..D {
                            right[d] += total * weights[d];
                        }
                    }
                }
            }
        }
        if stepped {
            for i in 0..N {
                right[i] += delta * (xi + noise[i] * self.a_at_one);
            }
        }
        for (tied, slope) in self.tied.iter().zip(self.slopes.as_chunks::<D>().0) {
            keep_apart();
            let mut direct = Lane::ZERO;
            let support = &self.support[tied.entries.clone()];
            if self.bilinear {
                for (lag, &(group, _)) in support.iter().enumerate() {
                    keep_apart();
                    let left = residuals[group] * count(parts, group);
                    right[N + lag] += first[tied.local] * left;
                    direct += change[N + lag] * left;
                }
                for d in 0..D {
                    right[d] -= direct * slope[d];
                }
            }
            for &(group, weight) in support {
                keep_apart();
                direct += along[group] * (weight * count(parts, group));
            }
            second[tied.local] = direct * tied.inverse;
        }
        right
    }

    /// Second order of the local columns, given that of the core.
    #[inline(always)]
    fn locals_second<const N: usize, const D: usize>(&self, bent: &[Lane; D], scratch: &mut Scratch) {
        let Scratch { along, rows, second, .. } = scratch;
        for ((group, lags), along) in self.groups.iter().zip(self.lags.as_chunks::<N>().0).zip(along) {
            keep_apart();
            let Local::Alone(local) = group.local else { continue };
            let mut value = *along - rows[group.row];
            for i in 0..N {
                value += bent[i] * lags[i];
            }
            second[local] = value;
        }
        for (tied, slope) in self.tied.iter().zip(self.slopes.as_chunks::<D>().0) {
            keep_apart();
            for d in 0..D {
                second[tied.local] -= bent[d] * slope[d];
            }
        }
    }

    /// Both orders of every parameter.
    #[inline(always)]
    fn read<const N: usize, const D: usize>(
        &self,
        (change, bent, delta): (&[Lane; D], &[Lane; D], Lane),
        scratch: &Scratch,
        first: &mut Vec<Lane>,
        second: &mut Vec<Lane>,
    ) {
        first.clear();
        second.clear();
        first.extend_from_slice(&change[..2 * N]);
        second.extend_from_slice(&bent[..2 * N]);
        let b: &[f64; N] = self.b.first_chunk().expect("the order is that of the code that was chosen");
        let Held { core, step, u, v, output, constant } = &self.base;
        let (mut of_a, mut of_v) = (Lane::ZERO, Lane::ZERO);
        let (mut inner, mut norm, mut bent_norm) = (Lane::ZERO, Lane::ZERO, Lane::ZERO);
        for i in 0..N {
            of_a += change[i];
            of_v += change[N + i];
            inner += change[N + i] * (2.0 * b[i]);
            norm += change[N + i] * change[N + i];
            bent_norm += bent[N + i] * (2.0 * b[i]);
        }
        let (of_u, own) = if *constant {
            (change[D - 1] + of_a * *output, Lane::ZERO)
        } else {
            (of_a * *output + delta * self.a_at_one, of_a * delta)
        };
        let bend = bend_of_ratio((*u, of_u, own), (*v, of_v, Lane::ZERO));
        let (mut base_first, mut base_second) = (delta * *step, bend);
        for d in 0..D {
            base_first += change[d] * core[d];
            base_second += bent[d] * core[d];
        }
        let squared: f64 = b.iter().map(|b| b * b).sum();
        for rule in &self.rules {
            keep_apart();
            let (mut of_first, mut of_second) = (base_first, base_second);
            match *rule {
                LevelRule::Known(_) => {}
                LevelRule::Local(local) => {
                    of_first += scratch.first[local];
                    of_second += scratch.second[local];
                }
                LevelRule::RankOne { first: l, .. } => {
                    let h = &self.local[l..l + N];
                    let (of_h, bent_h) = (&scratch.first[l..l + N], &scratch.second[l..l + N]);
                    let (mut value, mut sum, mut product, mut bent_sum) =
                        (0.0, Lane::ZERO, Lane::ZERO, Lane::ZERO);
                    for i in 0..N {
                        value += b[i] * h[i];
                        sum += change[N + i] * h[i] + of_h[i] * b[i];
                        product += change[N + i] * of_h[i];
                        bent_sum += bent[N + i] * h[i] + bent_h[i] * b[i];
                    }
                    let level = value / squared;
                    of_first += (sum - inner * level) * (1.0 / squared);
                    of_second += (bent_sum - bent_norm * level) * (1.0 / squared);
                    of_second += bend_of_ratio((value, sum, product), (squared, inner, norm));
                }
            }
            first.push(of_first);
            second.push(of_second);
        }
    }
}

/// Samples of a group, counted through all experiments.
#[inline(always)]
fn count(parts: &[&LaneStatistics], group: usize) -> f64 {
    let first = parts[0].counts.len();
    if group < first { parts[0].counts[group] } else { parts[1].counts[group - first] }
}

/// The second-order part of a ratio: of numerator and denominator are given the value, the first-order part and the second.
#[inline(always)]
fn bend_of_ratio((u, u1, u2): (f64, Lane, Lane), (v, v1, v2): (f64, Lane, Lane)) -> Lane {
    (u2 - v2 * (u / v) - (u1 - v1 * (u / v)) * v1 * (1.0 / v)) * (1.0 / v)
}
