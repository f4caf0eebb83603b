//! Least squares on grouped statistics, where most columns touch only a group or two of their own.

use super::grouped::GroupedStatistics;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// A column of the regression that is non-zero in a few groups only: weight `w` in each group listed.
///
/// Local columns of one regression have disjoint groups, so their block of the normal equations is diagonal.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LocalColumn {
    /// Group and weight.
    pub(crate) support: Vec<(usize, f64)>,
}

impl LocalColumn {
    /// A free mean for one group.
    pub(crate) fn own(group: usize) -> Self {
        Self { support: vec![(group, 1.0)] }
    }

    /// The column's product with a target that is `residual` in the groups.
    pub(super) fn target(&self, residual: &[f64]) -> f64 {
        self.support.iter().map(|&(q, w)| w * residual[q]).sum()
    }
}

/// The input part of a regression over groups: `y(t) = −Σaᵢy(t−i) + o_q + x_qᵀη + Σ_l w_q,l λ_l + ξ(t)`.
#[derive(Debug, Clone)]
pub(crate) struct Columns {
    /// `x`, one row a group.
    pub(crate) shared: DMatrix<f64>,
    /// The local columns.
    pub(crate) local: Vec<LocalColumn>,
    /// `o`, a known part of `y` one value a group.
    pub(crate) offset: Vec<f64>,
    /// Whether the columns are a rank-one product linearised: every local column is a level seen at lags `1…n`, its weights are `b`, and at lag
    /// `i` the shared column of `bᵢ` holds the level. An error in the level is then one in that column.
    pub(crate) bilinear: bool,
}

/// A solved regression: estimates, residual variance and covariance.
///
/// The core parameters are `(a₁…aₙ, η)`; the local ones `λ` are eliminated first (the normal equations are an arrow), so
/// the cost is `O((n + p)²)` a local column and `O((n + p)³)` once, instead of cubic in all columns.
#[derive(Debug, Clone)]
pub(crate) struct ArrowFit {
    /// `(a, η)`.
    pub(crate) core: DVector<f64>,
    /// `λ`.
    pub(crate) local: Vec<f64>,
    /// Residual variance, degrees of freedom counted.
    pub(crate) variance: f64,
    freedom: f64,
    pub(super) factor: Cholesky<f64, Dyn>,
    pub(super) ties: Vec<LocalTie>,
}

/// Residuals `r` against every column: `Σ_{t∈q} r(t)` a group, `−Σ_t y(t−i) r(t)` a lag, and `Σ_t r²(t)`.
#[derive(Debug, Clone)]
pub(crate) struct Score {
    pub(crate) residual: Vec<f64>,
    pub(crate) lagged: Vec<f64>,
    pub(crate) energy: f64,
}

/// What eliminating a local column leaves behind.
#[derive(Debug, Clone)]
pub(super) struct LocalTie {
    /// Its own entry `D = Σ K w²` of the normal matrix.
    pub(super) own: f64,
    /// `c/D`: how its estimate follows the core's.
    pub(super) slope: DVector<f64>,
    /// Right-hand side over `D`: its estimate were the core zero.
    start: f64,
}

/// A linear functional of the parameters: derivative of some quantity in the core and the local ones.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Gradient {
    /// Over `(a, η)`.
    pub(crate) core: DVector<f64>,
    /// Over the local columns named by index; the rest are zero.
    pub(crate) local: Vec<(usize, f64)>,
}

/// The normal matrix cannot be inverted: the record does not excite every parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct NotExcited;

impl ArrowFit {
    /// Solves the regression.
    pub(crate) fn solve(statistics: &GroupedStatistics, columns: &Columns) -> Result<Self, NotExcited> {
        let (n, p) = (statistics.order(), columns.shared.ncols());
        let (mut normal, mut right, mut energy) = core_equations(statistics, columns);
        let scale: Vec<f64> = normal.diagonal().iter().map(|d| d.abs().sqrt()).collect();
        let mut ties = Vec::with_capacity(columns.local.len());
        for column in &columns.local {
            let mut own = 0.0;
            let mut target = 0.0;
            let mut cross = DVector::zeros(n + p);
            for &(q, w) in &column.support {
                let count = statistics.count(q);
                own += w * w * count;
                target += w * (statistics.sum(q, 0) - columns.offset[q] * count);
                for i in 0..n {
                    cross[i] -= w * statistics.sum(q, i + 1);
                }
                for k in 0..p {
                    cross[n + k] += w * count * columns.shared[(q, k)];
                }
            }
            if own <= 0.0 {
                return Err(NotExcited);
            }
            let start = target / own;
            right.axpy(-start, &cross, 1.0);
            normal.ger(-1.0 / own, &cross, &cross, 1.0);
            energy -= target * start;
            ties.push(LocalTie { own, slope: cross / own, start });
        }
        let factor = well_conditioned(normal, &scale)?;
        let core = factor.solve(&right);
        let local: Vec<f64> = ties.iter().map(|tie| tie.start - tie.slope.dot(&core)).collect();
        let freedom = (statistics.samples() - (n + p + local.len()) as f64).max(1.0);
        let variance = (energy - core.dot(&right)).max(0.0) / freedom;
        Ok(Self { core, local, variance, freedom, factor, ties })
    }

    /// Variance of the quantity whose derivative is `gradient`, for white equation error.
    pub(crate) fn variance_of(&self, gradient: &Gradient) -> f64 {
        let through = self.through_core(gradient);
        let own = self.product_of_locals(gradient, gradient);
        self.variance * (own + through.dot(&self.factor.solve(&through)))
    }

    /// Covariances of several parameters with the given derivatives, row by row.
    pub(crate) fn covariances_of(&self, gradients: &[&Gradient]) -> Vec<Vec<f64>> {
        let through: Vec<_> = gradients.iter().map(|g| self.through_core(g)).collect();
        let row = |i: usize| {
            let solved = self.factor.solve(&through[i]);
            let own = |j: usize| self.product_of_locals(gradients[i], gradients[j]);
            (0..gradients.len()).map(|j| self.variance * (own(j) + through[j].dot(&solved))).collect()
        };
        (0..gradients.len()).map(row).collect()
    }

    /// What a derivative amounts to in the core, where the local columns follow it.
    pub(super) fn through_core(&self, gradient: &Gradient) -> DVector<f64> {
        let mut core = gradient.core.clone();
        gradient.local.iter().for_each(|&(l, weight)| core.axpy(-weight, &self.ties[l].slope, 1.0));
        core
    }

    /// `Σ_l x_l y_l / D_l` of two derivatives.
    pub(super) fn product_of_locals(&self, x: &Gradient, y: &Gradient) -> f64 {
        let shared = |&(l, weight): &(usize, f64)| {
            let same = y.local.iter().filter(|(k, _)| *k == l).map(|(_, weight)| weight);
            same.map(|other| weight * other / self.ties[l].own).sum::<f64>()
        };
        x.local.iter().map(shared).sum()
    }

    /// Adds the correction for what a pass over the data finds left in the residual, and takes the residual variance from there.
    pub(crate) fn refine(&mut self, columns: &Columns, score: &Score) {
        let step = self.respond(columns, &score.residual, &score.lagged);
        self.core += step.core;
        self.local.iter_mut().zip(step.local).for_each(|(l, s)| *l += s);
        self.variance = score.energy / self.freedom;
    }

    /// How all parameters answer to a target that is `residual` in the groups and `lagged` against the lags:
    /// `Σ_{t∈q} r(t)` a group and `−Σ_t y(t−i) r(t)` a lag.
    pub(crate) fn respond(&self, columns: &Columns, residual: &[f64], lagged: &[f64]) -> Response {
        let core = self.factor.solve(&self.core_side(columns, residual, lagged));
        let start = |column: &LocalColumn, tie: &LocalTie| column.target(residual) / tie.own;
        let local = columns
            .local
            .iter()
            .zip(&self.ties)
            .map(|(column, tie)| start(column, tie) - tie.slope.dot(&core))
            .collect();
        Response { core, local }
    }

    /// The core's right-hand side for such a target, the local columns eliminated.
    pub(crate) fn core_side(&self, columns: &Columns, residual: &[f64], lagged: &[f64]) -> DVector<f64> {
        let (n, p) = (lagged.len(), columns.shared.ncols());
        let mut right = DVector::zeros(n + p);
        right.rows_mut(0, n).copy_from_slice(lagged);
        for (q, r) in residual.iter().enumerate() {
            for k in 0..p {
                right[n + k] += columns.shared[(q, k)] * r;
            }
        }
        for (column, tie) in columns.local.iter().zip(&self.ties) {
            right.axpy(-column.target(residual), &tie.slope, 1.0);
        }
        right
    }

    /// [`Self::core_side`] of a target that is one in a single group: one row a group.
    pub(super) fn core_sides(&self, columns: &Columns, lags: usize) -> Vec<f64> {
        let groups = columns.offset.len();
        let probe = |group: usize| (0..groups).map(|q| f64::from(q == group)).collect::<Vec<_>>();
        let side = |group: usize| self.core_side(columns, &probe(group), &vec![0.0; lags]);
        (0..groups).flat_map(|group| side(group).iter().copied().collect::<Vec<_>>()).collect()
    }

    /// What a quantity takes of a target: weights of [`Self::core_side`], and weights of single groups.
    pub(crate) fn answer(&self, columns: &Columns, gradient: &Gradient) -> (DVector<f64>, Vec<(usize, f64)>) {
        let of_column = |&(l, weight): &(usize, f64)| {
            let own = self.ties[l].own;
            columns.local[l].support.iter().map(move |&(q, w)| (q, weight * w / own))
        };
        let own = gradient.local.iter().flat_map(of_column).collect();
        (self.factor.solve(&self.through_core(gradient)), own)
    }

    /// How all parameters move with a constant 1 left in `y`; `statistics` and `columns` are those that were solved.
    pub(crate) fn response_to_constant(&self, statistics: &GroupedStatistics, columns: &Columns) -> Response {
        let residual: Vec<f64> = (0..statistics.groups()).map(|q| statistics.count(q)).collect();
        let lagged: Vec<f64> = (1..=statistics.order()).map(|i| -statistics.total(i)).collect();
        self.respond(columns, &residual, &lagged)
    }

    /// How all parameters answer to a right-hand side of the core with the local columns eliminated.
    pub(super) fn respond_to_core(&self, right: &DVector<f64>) -> Response {
        let core = self.factor.solve(right);
        let local = self.ties.iter().map(|tie| -tie.slope.dot(&core)).collect();
        Response { core, local }
    }

    /// `o_q + x_qᵀη + Σ_l w_q,l λ_l`.
    pub(crate) fn group_means(&self, columns: &Columns) -> Vec<f64> {
        let n = self.core.len() - columns.shared.ncols();
        let eta = self.core.rows(n, columns.shared.ncols());
        let mut means: Vec<f64> = columns
            .offset
            .iter()
            .enumerate()
            .map(|(q, o)| o + columns.shared.row(q).transpose().dot(&eta))
            .collect();
        for (column, lambda) in columns.local.iter().zip(&self.local) {
            for &(q, w) in &column.support {
                means[q] += w * lambda;
            }
        }
        means
    }
}

/// A change of all parameters.
#[derive(Debug, Clone)]
pub(crate) struct Response {
    pub(super) core: DVector<f64>,
    pub(super) local: Vec<f64>,
}

impl Response {
    /// The same change, so many times.
    pub(super) fn times(mut self, factor: f64) -> Self {
        self.core *= factor;
        self.local.iter_mut().for_each(|l| *l *= factor);
        self
    }

    /// Both changes.
    pub(super) fn plus(mut self, other: &Self) -> Self {
        self.core += &other.core;
        self.local.iter_mut().zip(&other.local).for_each(|(l, o)| *l += o);
        self
    }

    /// The change of the quantity whose derivative is `gradient`.
    pub(crate) fn along(&self, gradient: &Gradient) -> f64 {
        gradient.core.dot(&self.core) + gradient.local.iter().map(|&(l, w)| w * self.local[l]).sum::<f64>()
    }
}

/// Normal matrix and right-hand side of `(a, η)`, and the energy of the target.
fn core_equations(statistics: &GroupedStatistics, columns: &Columns) -> (DMatrix<f64>, DVector<f64>, f64) {
    let (n, p) = (statistics.order(), columns.shared.ncols());
    let mut normal = DMatrix::zeros(n + p, n + p);
    let mut right = DVector::zeros(n + p);
    let mut energy = statistics.product(0, 0);
    for i in 0..n {
        right[i] = -statistics.product(0, i + 1);
        for l in 0..n {
            normal[(i, l)] = statistics.product(i + 1, l + 1);
        }
    }
    for q in 0..statistics.groups() {
        let (count, offset) = (statistics.count(q), columns.offset[q]);
        let target = statistics.sum(q, 0) - offset * count;
        energy -= offset * (statistics.sum(q, 0) + target);
        for i in 0..n {
            right[i] += offset * statistics.sum(q, i + 1);
        }
        for k in 0..p {
            let x = columns.shared[(q, k)];
            if x == 0.0 {
                continue;
            }
            right[n + k] += x * target;
            for i in 0..n {
                normal[(i, n + k)] -= x * statistics.sum(q, i + 1);
            }
            for l in 0..p {
                normal[(n + k, n + l)] += x * columns.shared[(q, l)] * count;
            }
        }
    }
    for i in 0..n {
        for k in 0..p {
            normal[(n + k, i)] = normal[(i, n + k)];
        }
    }
    (normal, right, energy)
}

/// Factors the reduced normal matrix, refusing one that is singular to working precision; `scale` holds the norms
/// of the core columns before the elimination.
fn well_conditioned(normal: DMatrix<f64>, scale: &[f64]) -> Result<Cholesky<f64, Dyn>, NotExcited> {
    let factor = Cholesky::new(normal).ok_or(NotExcited)?;
    let l = factor.l_dirty();
    // A pivot that kept less than 1e-7 of its column (1e-14 of its energy) lost all its digits to the others.
    let sound = scale.iter().enumerate().all(|(i, s)| *s > 0.0 && l[(i, i)] > 1e-7 * s);
    if sound { Ok(factor) } else { Err(NotExcited) }
}
