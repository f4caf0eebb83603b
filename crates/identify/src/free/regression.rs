//! The regression of one input, for many outputs.

use super::cells::Cells;
use super::equation_error::Moments;
use super::error::FreeError;
use super::errors::equation_error_estimate;
use super::fit::quick_equation_error_fit;
use super::one_shot::Grid;
use super::problem::Segment;
use crate::Estimate;
use nalgebra::DMatrix;
use switchback_model::reversal::Branches;

/// The regression of [`one_shot`](super::one_shot) on one input, at several numbers of samples: everything that the output does not touch is
/// worked out once.
///
/// With `ψ(t)` the hats at every lag and a one, the output enters the moments through
///
/// ```text
/// Σ_t y(t−i) y(t−l)    i, l = 0…n    (n+1) × (n+1), bilinear
/// Σ_t y(t−i) ψ(t)      i = 0…n       (n+1) × p,     linear
/// ```
///
/// so the moments of `y = z + σe` for any `σ` follow from the sums of `z` and `e` alone. A signal costs `O(n²)` a sample, once, whatever the number
/// of checkpoints.
#[derive(Debug, Clone)]
pub struct Regression {
    grid: Grid,
    pub(super) cells: Cells,
    start: usize,
    pub(super) checkpoints: Vec<usize>,
    /// `Σψψᵀ` at each checkpoint.
    input: Vec<DMatrix<f64>>,
}

impl Regression {
    /// Reads the branches of `v` and sums what the input alone decides. `checkpoints` are numbers of regression samples `N`, increasing.
    ///
    /// # Errors
    /// [`FreeError`] if the input never moves or is shorter than the last checkpoint needs, or if the samples of the first one pass by a knot
    /// or are fewer than two a parameter.
    pub fn new(v: &[f64], grid: Grid, checkpoints: &[usize]) -> Result<Self, FreeError> {
        let regression = Self::unchecked(v, grid, checkpoints)?;
        if let Some(first) = checkpoints.first() {
            let (from, cells) = (regression.start, &regression.cells);
            let segment =
                [Segment { y: v, cells, from, to: from + first, weights: None, counted_from: from }];
            regression.grid.basis.check_visits(&segment)?;
            regression.grid.basis.check_length(regression.grid.structure, &segment)?;
        }
        Ok(regression)
    }

    /// The same for a grid that no estimate is asked of.
    pub(super) fn unchecked(v: &[f64], grid: Grid, checkpoints: &[usize]) -> Result<Self, FreeError> {
        let Grid { structure, ref basis, rule } = grid;
        let branches = Branches::of(v, rule).ok_or(FreeError::NoMotion { threshold: rule.threshold })?;
        let cells = Cells::of(basis, v, &branches);
        let start = branches.first_known() + structure.memory();
        let available = v.len().saturating_sub(start + structure.ahead());
        if let Some(wanted) = checkpoints.last().copied().filter(|&last| last > available) {
            return Err(FreeError::InputTooShort { available, wanted });
        }
        let mut regression =
            Self { grid, cells, start, checkpoints: checkpoints.to_vec(), input: Vec::new() };
        regression.input = regression.sums_of_input();
        Ok(regression)
    }

    /// The first sample that is explained; those before it serve as its past.
    pub(crate) fn start(&self) -> usize {
        self.start
    }

    /// `Σ_t x(t−i) w(t−l)`, rows `i` and columns `l` from 0 to `n`, at each checkpoint.
    ///
    /// # Panics
    /// If a signal ends before the last checkpoint.
    pub fn lag_products(&self, x: &[f64], w: &[f64]) -> Vec<DMatrix<f64>> {
        let width = self.grid.structure.order + 1;
        self.accumulate(DMatrix::zeros(width, width), |t, sums| {
            let (x, w) = (&x[t + 1 - width..=t], &w[t + 1 - width..=t]);
            for (l, w) in w.iter().rev().enumerate() {
                for (sum, x) in sums.column_mut(l).iter_mut().zip(x.iter().rev()) {
                    *sum += x * w;
                }
            }
        })
    }

    /// `Σ_t x(t−i) ψ(t)`, rows `i` from 0 to `n`, at each checkpoint.
    ///
    /// # Panics
    /// If the signal ends before the last checkpoint.
    pub fn input_products(&self, x: &[f64]) -> Vec<DMatrix<f64>> {
        let width = self.grid.structure.order + 1;
        let mut row = Vec::new();
        self.accumulate(DMatrix::zeros(width, self.regressors()), |t, sums| {
            let x = &x[t + 1 - width..=t];
            self.fill_row(t, &mut row);
            for &(q, weight) in &row {
                for (sum, x) in sums.column_mut(q).iter_mut().zip(x.iter().rev()) {
                    *sum += x * weight;
                }
            }
        })
    }

    /// The moments, at checkpoint number `checkpoint`, of an output with these sums.
    ///
    /// # Panics
    /// If the sums have other shapes than [`Self::lag_products`] and [`Self::input_products`] give.
    pub fn moments(&self, checkpoint: usize, lags: &DMatrix<f64>, input: &DMatrix<f64>) -> Moments {
        let (n, p) = (self.grid.structure.order, self.regressors());
        assert!(lags.shape() == (n + 1, n + 1) && input.shape() == (n + 1, p), "sums of this regression");
        // Lags 1…n enter with a minus sign and come first; the output itself comes last.
        let place = |lag: usize| if lag == 0 { (n + p, 1.0) } else { (lag - 1, -1.0) };
        let mut matrix = DMatrix::zeros(n + p + 1, n + p + 1);
        matrix.view_mut((n, n), (p, p)).copy_from(&self.input[checkpoint]);
        for i in 0..=n {
            let (row, sign) = place(i);
            for l in 0..=n {
                let (column, other) = place(l);
                matrix[(row, column)] = sign * other * lags[(i, l)];
            }
            for q in 0..p {
                matrix[(row, n + q)] = sign * input[(i, q)];
                matrix[(n + q, row)] = sign * input[(i, q)];
            }
        }
        let width = self.grid.basis.features();
        Moments { structure: self.grid.structure, width, matrix, samples: self.checkpoints[checkpoint] }
    }

    /// Least squares and rank one: what [`one_shot`](super::one_shot) makes of the same samples.
    ///
    /// Only where the samples leave a coefficient `bᵢf_k` all but open can the two differ: `one_shot` then tries other starts as well.
    ///
    /// # Errors
    /// [`FreeError::Unstable`] if nothing fits.
    pub fn estimate(&self, moments: &Moments) -> Result<Estimate, FreeError> {
        let order = self.grid.structure.order;
        let theta = quick_equation_error_fit(moments).ok_or(FreeError::Unstable { order })?;
        Ok(equation_error_estimate(moments, &self.grid.basis, &theta))
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Length of `ψ`.
    fn regressors(&self) -> usize {
        self.grid.structure.numerator() * self.grid.basis.features() + 1
    }

    fn sums_of_input(&self) -> Vec<DMatrix<f64>> {
        let p = self.regressors();
        let mut row = Vec::new();
        self.accumulate(DMatrix::zeros(p, p), |t, sums| {
            self.fill_row(t, &mut row);
            for &(p, x) in &row {
                for &(q, z) in &row {
                    sums[(p, q)] += x * z;
                }
            }
        })
    }

    /// The non-zeros of `ψ(t)`.
    fn fill_row(&self, t: usize, row: &mut Vec<(usize, f64)>) {
        let (structure, width) = (self.grid.structure, self.grid.basis.features());
        row.clear();
        for i in 0..structure.numerator() {
            row.extend(self.cells.at(structure.input(t, i)).features().map(|(k, x)| (i * width + k, x)));
        }
        row.push((structure.numerator() * width, 1.0));
    }

    /// Adds up over the samples and keeps the sums at each checkpoint.
    fn accumulate(
        &self,
        mut sums: DMatrix<f64>,
        mut add: impl FnMut(usize, &mut DMatrix<f64>),
    ) -> Vec<DMatrix<f64>> {
        let mut done = 0;
        let mut kept = Vec::with_capacity(self.checkpoints.len());
        for &samples in &self.checkpoints {
            for t in self.start + done..self.start + samples {
                add(t, &mut sums);
            }
            done = samples;
            kept.push(sums.clone());
        }
        kept
    }
}
