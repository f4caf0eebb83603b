//! The arrow of [`super::super::arrow`], eight replicates abreast.

use super::lane::{LANES, Lane};
use super::statistics::LaneStatistics;

/// Groups, rows and local columns of a regression; see `Columns`.
#[derive(Debug, Clone)]
pub(super) struct LaneColumns {
    /// Columns `p` of `x`.
    pub(super) width: usize,
    /// `x`, `p` a group.
    pub(super) shared: Vec<Lane>,
    /// `o`, one a group.
    pub(super) offset: Vec<Lane>,
    /// Whether the group has a mean of its own, and so drops out of everything else.
    pub(super) saturated: Vec<bool>,
    /// Group and weight, column by column.
    pub(super) local: Vec<Vec<(usize, Lane)>>,
}

/// A replicate whose pivot keeps less than this share of its diagonal entry is left to the solver that goes one by one.
const SOUND: f64 = 1e-12;

/// A solved regression of eight replicates, in memory that is used again and again.
#[derive(Debug, Clone, Default)]
pub(super) struct LaneArrow {
    /// Core parameters `n + p`.
    pub(super) size: usize,
    /// `(a, η)`.
    pub(super) core: Vec<Lane>,
    /// `λ`.
    pub(super) local: Vec<Lane>,
    /// Residual variance.
    pub(super) variance: Lane,
    /// Whether each replicate was solved.
    pub(super) sound: [bool; LANES],
    /// `D`, one a local column.
    pub(super) own: Vec<Lane>,
    /// How the core answers to a constant 1 left in `y`.
    pub(super) constant: Vec<Lane>,
    slopes: Vec<Lane>,
    starts: Vec<Lane>,
    factor: Vec<Lane>,
    right: Vec<Lane>,
    regressors: Vec<Lane>,
    cross: Vec<Lane>,
}

impl Default for Lane {
    #[inline(always)]
    fn default() -> Self {
        Self::ZERO
    }
}

impl LaneArrow {
    /// Solves the regression for statistics of `y − shift`, experiments side by side.
    #[inline(always)]
    pub(super) fn solve(&mut self, parts: &[&LaneStatistics], shift: Lane, columns: &LaneColumns) {
        let n = parts[0].order();
        self.size = n + columns.width;
        self.sound = [true; LANES];
        let mut energy = self.begin(parts, columns.local.len());
        self.read_regressors(parts, shift, columns);
        let mut samples = 0.0;
        for (q, count) in parts.iter().flat_map(|part| &part.counts).copied().enumerate() {
            samples += count;
            if !columns.saturated[q] {
                energy += self.add_group(q, count);
            }
        }
        let counts = |q: usize| {
            let first = parts[0].counts.len();
            if q < first { parts[0].counts[q] } else { parts[1].counts[q - first] }
        };
        for (l, support) in columns.local.iter().enumerate() {
            energy -= self.eliminate(l, support, columns.saturated[support[0].0], counts);
        }
        self.factorise();
        self.core.copy_from_slice(&self.right);
        solve_in_place(&self.factor, &mut self.core);
        solve_in_place(&self.factor, &mut self.constant);
        for l in 0..columns.local.len() {
            self.local[l] = self.starts[l] - dot(self.slope(l), &self.core);
        }
        let freedom = (samples - (self.size + columns.local.len()) as f64).max(1.0);
        self.variance = (energy - dot(&self.core, &self.right)).at_least(0.0) * (1.0 / freedom);
    }

    /// `c/D` of a local column.
    #[inline(always)]
    pub(super) fn slope(&self, local: usize) -> &[Lane] {
        &self.slopes[local * self.size..(local + 1) * self.size]
    }

    /// `gᵀN⁻¹g`; overwrites `g`.
    #[inline(always)]
    pub(super) fn quadratic(&self, g: &mut [Lane]) -> Lane {
        forward(&self.factor, g);
        dot(g, g)
    }

    /// Within-group products; the energy so far.
    #[inline(always)]
    fn begin(&mut self, parts: &[&LaneStatistics], locals: usize) -> Lane {
        let (n, d) = (parts[0].order(), self.size);
        for (memory, length) in [
            (&mut self.core, d),
            (&mut self.constant, d),
            (&mut self.right, d),
            (&mut self.cross, d),
            (&mut self.factor, d * d),
            (&mut self.local, locals),
            (&mut self.own, locals),
            (&mut self.starts, locals),
            (&mut self.slopes, locals * d),
        ] {
            memory.clear();
            memory.resize(length, Lane::ZERO);
        }
        let mut energy = Lane::ZERO;
        for part in parts {
            energy += part.within[0];
            for i in 0..n {
                self.right[i] -= part.within[i + 1];
                for l in 0..=i {
                    self.factor[i * d + l] += part.within[(i + 1) * (n + 1) + l + 1];
                }
            }
        }
        energy
    }

    /// `(−m_1…−m_n, x, m_0 − o)`, one row a group.
    #[inline(always)]
    fn read_regressors(&mut self, parts: &[&LaneStatistics], shift: Lane, columns: &LaneColumns) {
        let p = columns.width;
        self.regressors.clear();
        let mut q = 0;
        for part in parts {
            for group in 0..part.counts.len() {
                let mean = part.mean(group);
                self.regressors.extend(mean[1..].iter().map(|m| shift - *m));
                self.regressors.extend_from_slice(&columns.shared[q * p..(q + 1) * p]);
                self.regressors.push(mean[0] - shift - columns.offset[q]);
                q += 1;
            }
        }
    }

    /// Adds a group to the normal equations; returns its energy.
    #[inline(always)]
    fn add_group(&mut self, q: usize, count: f64) -> Lane {
        let d = self.size;
        let row = &self.regressors[q * (d + 1)..(q + 1) * (d + 1)];
        let target = row[d];
        for i in 0..d {
            let weighted = row[i] * count;
            self.constant[i] += weighted;
            self.right[i] += weighted * target;
            for l in 0..=i {
                self.factor[i * d + l] += weighted * row[l];
            }
        }
        target * target * count
    }

    /// Takes a local column out of the normal equations; returns the energy that it explains. Of a group with its own mean nothing was put in.
    #[inline(always)]
    fn eliminate(
        &mut self,
        l: usize,
        support: &[(usize, Lane)],
        saturated: bool,
        counts: impl Fn(usize) -> f64,
    ) -> Lane {
        let d = self.size;
        let slope = &mut self.slopes[l * d..(l + 1) * d];
        if saturated {
            let q = support[0].0;
            let row = &self.regressors[q * (d + 1)..(q + 1) * (d + 1)];
            slope.copy_from_slice(&row[..d]);
            self.starts[l] = row[d];
            self.own[l] = Lane::splat(counts(q));
            return Lane::ZERO;
        }
        let (mut own, mut target) = (Lane::ZERO, Lane::ZERO);
        self.cross.fill(Lane::ZERO);
        for &(q, w) in support {
            let row = &self.regressors[q * (d + 1)..(q + 1) * (d + 1)];
            let weight = w * counts(q);
            own += weight * w;
            target += weight * row[d];
            for i in 0..d {
                self.cross[i] += weight * row[i];
            }
        }
        let inverse = Lane::splat(1.0) / own;
        let start = target * inverse;
        for i in 0..d {
            slope[i] = self.cross[i] * inverse;
            self.right[i] -= self.cross[i] * start;
            for j in 0..=i {
                self.factor[i * d + j] -= slope[i] * self.cross[j];
            }
        }
        self.own[l] = own;
        self.starts[l] = start;
        target * start
    }

    /// Cholesky in place, the inverse pivots on the diagonal.
    #[inline(always)]
    fn factorise(&mut self) {
        let d = self.size;
        for j in 0..d {
            let before = self.factor[j * d + j];
            let mut pivot = before;
            for k in 0..j {
                let x = self.factor[j * d + k];
                pivot -= x * x;
            }
            for (l, sound) in self.sound.iter_mut().enumerate() {
                *sound &= pivot.0[l] > SOUND * before.0[l];
            }
            let inverse = Lane::splat(1.0) / pivot.sqrt();
            self.factor[j * d + j] = inverse;
            for i in j + 1..d {
                let mut x = self.factor[i * d + j];
                for k in 0..j {
                    x -= self.factor[i * d + k] * self.factor[j * d + k];
                }
                self.factor[i * d + j] = x * inverse;
            }
        }
    }
}

/// `Σ xᵢyᵢ`.
#[inline(always)]
pub(super) fn dot(x: &[Lane], y: &[Lane]) -> Lane {
    let mut sum = Lane::ZERO;
    for (x, y) in x.iter().zip(y) {
        sum += *x * *y;
    }
    sum
}

/// `L⁻¹x` in place; `L` row by row with its inverse diagonal.
#[inline(always)]
fn forward(factor: &[Lane], x: &mut [Lane]) {
    let d = x.len();
    for i in 0..d {
        let mut value = x[i];
        for k in 0..i {
            value -= factor[i * d + k] * x[k];
        }
        x[i] = value * factor[i * d + i];
    }
}

/// `(LLᵀ)⁻¹x` in place.
#[inline(always)]
fn solve_in_place(factor: &[Lane], x: &mut [Lane]) {
    forward(factor, x);
    let d = x.len();
    for i in (0..d).rev() {
        let mut value = x[i];
        for k in i + 1..d {
            value -= factor[k * d + i] * x[k];
        }
        x[i] = value * factor[i * d + i];
    }
}
