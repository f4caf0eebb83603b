//! The arrow of [`super::super::arrow`], eight replicates abreast.

use super::columns::{ColumnPlan, ColumnValues, LocalPlan};
use super::factor::{Factor, dot};
use super::statistics::LaneStatistics;
use switchback_noise::lanes::{LANES, Lane, keep_apart};

/// A regression to be solved: statistics of `y − shift`, experiments side by side, and its columns.
#[derive(Clone, Copy)]
pub(super) struct Regression<'a> {
    pub(super) parts: &'a [&'a LaneStatistics],
    pub(super) shift: Lane,
    pub(super) plan: &'a ColumnPlan,
    pub(super) values: &'a ColumnValues,
}

/// A group as the core sees it: `(−m₁…−mₙ, x)`, `m₀ − o`, and its count.
struct Row<const D: usize> {
    regressors: [Lane; D],
    target: Lane,
    count: f64,
    /// `1/K`.
    share: f64,
}

/// A group's own mean in a regression whose other columns do not touch the group.
pub(super) struct OwnMean<const N: usize> {
    /// `λ`.
    pub(super) value: Lane,
    /// `c/D` on `a`; on the rest of the core it is zero.
    pub(super) slope: [Lane; N],
    /// `1/D`.
    pub(super) inverse: f64,
}

impl Regression<'_> {
    /// The statistics that a group belongs to, and its place there.
    #[inline(always)]
    fn place(&self, group: usize) -> (&LaneStatistics, usize) {
        let first = self.parts[0].counts.len();
        if group < first { (self.parts[0], group) } else { (self.parts[1], group - first) }
    }

    /// A local column that is its group's own mean, where all of them are [apart](ColumnPlan::apart), given `a`.
    #[inline(always)]
    pub(super) fn own_mean<const N: usize>(&self, local: usize, a: &[Lane]) -> OwnMean<N> {
        let group = self.plan.local[local].group;
        let (part, q) = self.place(group);
        let mean = &part.means[q * (N + 1)..(q + 1) * (N + 1)];
        let mut slope = [Lane::ZERO; N];
        for i in 0..N {
            slope[i] = self.shift - mean[i + 1];
        }
        let start = mean[0] - self.shift - self.values.offset[group];
        OwnMean { value: start - dot(&slope, a), slope, inverse: part.shares[q] }
    }

    #[inline(always)]
    fn row<const N: usize, const D: usize>(&self, group: usize) -> Row<D> {
        let (part, q) = self.place(group);
        let mean = &part.means[q * (N + 1)..(q + 1) * (N + 1)];
        let shared = &self.values.shared[group * (D - N)..(group + 1) * (D - N)];
        let mut regressors = [Lane::ZERO; D];
        for i in 0..N {
            regressors[i] = self.shift - mean[i + 1];
        }
        for (regressor, x) in regressors[N..].iter_mut().zip(shared) {
            *regressor = *x;
        }
        let target = mean[0] - self.shift - self.values.offset[group];
        Row { regressors, target, count: part.counts[q], share: part.shares[q] }
    }
}

/// The local columns of a solved regression of eight replicates, in memory that is used again and again.
#[derive(Debug, Clone, Default)]
pub(super) struct Locals {
    /// `λ`.
    pub(super) values: Vec<Lane>,
    /// `1/D`.
    pub(super) inverse: Vec<Lane>,
    /// `c/D`, `D` core parameters a column.
    slopes: Vec<Lane>,
}

impl Locals {
    /// `c/D` of a column.
    #[inline(always)]
    pub(super) fn slope<const D: usize>(&self, local: usize) -> &[Lane; D] {
        &self.slopes.as_chunks().0[local]
    }

    /// Room for so many columns of `size` core parameters.
    #[inline(always)]
    fn resize(&mut self, columns: usize, size: usize) {
        self.values.resize(columns, Lane::ZERO);
        self.inverse.resize(columns, Lane::ZERO);
        self.slopes.resize(columns * size, Lane::ZERO);
    }
}

/// The normal equations of the core.
pub(super) struct Equations<const D: usize> {
    /// The lower triangle.
    normal: [[Lane; D]; D],
    right: [Lane; D],
    constant: [Lane; D],
    energy: Lane,
}

/// The core of a solved regression of eight replicates: `N` lags, `D` parameters.
#[derive(Clone, Copy)]
pub(super) struct Core<const N: usize, const D: usize> {
    /// `(a, η)`.
    pub(super) parameters: [Lane; D],
    /// Residual variance.
    pub(super) variance: Lane,
    /// Whether each replicate was solved.
    pub(super) sound: [bool; LANES],
    /// How the core answers to a constant 1 left in `y`, where every local column is a group's mean.
    pub(super) constant: [Lane; D],
    factor: Factor<D>,
}

impl<const N: usize, const D: usize> Core<N, D> {
    /// Solves the equations of a regression.
    #[inline(always)]
    pub(super) fn solve(equations: &Equations<D>, regression: &Regression<'_>) -> Self {
        let (factor, sound) = Factor::new(&equations.normal);
        let parameters = factor.solve(&equations.right);
        let samples: f64 = regression.parts.iter().map(|part| part.samples).sum();
        let freedom = (samples - (D + regression.plan.local.len()) as f64).max(1.0);
        let left = equations.energy - dot(&parameters, &equations.right);
        Self {
            parameters,
            variance: left.at_least(0.0) * (1.0 / freedom),
            sound,
            constant: factor.solve(&equations.constant),
            factor,
        }
    }

    /// Puts the local columns of the regression into `locals`, where its equations left what they eliminated.
    #[inline(always)]
    pub(super) fn follow(&self, regression: &Regression<'_>, locals: &mut Locals) {
        let plan = regression.plan;
        locals.resize(plan.local.len(), D);
        let (slopes, _) = locals.slopes.as_chunks_mut::<D>();
        let columns = slopes.iter_mut().zip(&mut locals.values).zip(&mut locals.inverse);
        for (column, ((slope, value), inverse)) in plan.local.iter().zip(columns) {
            keep_apart();
            if column.own_mean {
                let row = regression.row::<N, D>(column.group);
                (*slope, *value, *inverse) = (row.regressors, row.target, Lane::splat(row.share));
            }
            *value -=
                if plan.apart { dot(&slope[..N], &self.parameters) } else { dot(slope, &self.parameters) };
        }
    }

    /// `gᵀN⁻¹g`.
    #[inline(always)]
    pub(super) fn quadratic(&self, gradient: &[Lane; D]) -> Lane {
        let solved = self.factor.forward(gradient);
        dot(&solved, &solved)
    }

    /// The diagonal of `N⁻¹`.
    #[inline(always)]
    pub(super) fn inverse_diagonal(&self) -> [Lane; D] {
        self.factor.inverse_diagonal()
    }
}

impl<const D: usize> Equations<D> {
    /// The equations of a regression; what it eliminates for them goes into `locals`.
    ///
    /// A column that is its group's own mean needs no elimination: nothing of its group is put in, so nothing is to be taken out.
    #[inline(always)]
    pub(super) fn of<const N: usize>(regression: &Regression<'_>, locals: &mut Locals) -> Self {
        let plan = regression.plan;
        let mut equations = Self::within::<N>(regression.parts);
        for &group in &plan.pooled {
            keep_apart();
            equations.add(&regression.row::<N, D>(group));
        }
        if !plan.apart {
            locals.resize(plan.local.len(), D);
            let (slopes, _) = locals.slopes.as_chunks_mut::<D>();
            let columns = slopes.iter_mut().zip(&mut locals.values).zip(&mut locals.inverse);
            for (column, ((slope, start), inverse)) in plan.local.iter().zip(columns) {
                keep_apart();
                if !column.own_mean {
                    (*slope, *start, *inverse) = equations.eliminate::<N>(regression, column);
                }
            }
        }
        equations
    }

    /// The products within groups.
    #[inline(always)]
    fn within<const N: usize>(parts: &[&LaneStatistics]) -> Self {
        let mut equations = Self {
            normal: [[Lane::ZERO; D]; D],
            right: [Lane::ZERO; D],
            constant: [Lane::ZERO; D],
            energy: Lane::ZERO,
        };
        for part in parts {
            let within = &part.within[..(N + 1) * (N + 1)];
            equations.energy += within[0];
            for i in 0..N {
                equations.right[i] -= within[i + 1];
                for l in 0..N {
                    if l <= i {
                        equations.normal[i][l] += within[(i + 1) * (N + 1) + l + 1];
                    }
                }
            }
        }
        equations
    }

    /// Adds a group.
    #[inline(always)]
    fn add(&mut self, row: &Row<D>) {
        for i in 0..D {
            let weighted = row.regressors[i] * row.count;
            self.constant[i] += weighted;
            self.right[i] += weighted * row.target;
            for l in 0..D {
                if l <= i {
                    self.normal[i][l] += weighted * row.regressors[l];
                }
            }
        }
        self.energy += row.target * row.target * row.count;
    }

    /// Takes out a local column; `c/D`, its estimate were the core zero, and `1/D`.
    #[inline(always)]
    fn eliminate<const N: usize>(
        &mut self,
        regression: &Regression<'_>,
        column: &LocalPlan,
    ) -> ([Lane; D], Lane, Lane) {
        let (mut own, mut target, mut cross) = (Lane::ZERO, Lane::ZERO, [Lane::ZERO; D]);
        let support = &regression.plan.support[column.entries.clone()];
        for (&group, &w) in support.iter().zip(&regression.values.weights[column.entries.clone()]) {
            keep_apart();
            let row = regression.row::<N, D>(group);
            let weight = w * row.count;
            own += weight * w;
            target += weight * row.target;
            for i in 0..D {
                cross[i] += weight * row.regressors[i];
            }
        }
        let inverse = Lane::splat(1.0) / own;
        let start = target * inverse;
        let mut slope = [Lane::ZERO; D];
        for i in 0..D {
            slope[i] = cross[i] * inverse;
            self.right[i] -= cross[i] * start;
            for l in 0..D {
                if l <= i {
                    self.normal[i][l] -= slope[i] * cross[l];
                }
            }
        }
        self.energy -= target * start;
        (slope, start, inverse)
    }
}
