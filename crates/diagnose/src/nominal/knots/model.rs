//! The model whose knots are placed.

use super::passages::Passages;
use crate::likelihood::engine::{Build, Fit, FitContext, fit};
use crate::model::borders::Grid;
use crate::records::dataset::Dataset;

/// What knots are placed for.
pub(super) struct Model<'a> {
    pub(super) dataset: &'a Dataset,
    pub(super) build: &'a Build<'a>,
    pub(super) passages: &'a Passages,
}

impl Model<'_> {
    pub(super) fn refitted(&self, fitted: &Fit, grid: &Grid) -> Option<Fit> {
        refitted(self.dataset, fitted, grid, self.build)
    }
}

/// The same model re-fitted on another grid.
pub(super) fn refitted(dataset: &Dataset, fitted: &Fit, grid: &Grid, build: &Build<'_>) -> Option<Fit> {
    let start = carried_over(fitted, grid);
    let known = Some(&**fitted.near());
    fit(FitContext { dataset, grid, known }, build, &fitted.nonlinear, &start, 5)
}

/// The linear parameters on a finer grid: the same borders.
pub(crate) fn carried_over(fit: &Fit, grid: &Grid) -> crate::likelihood::design::Linear {
    let mut p = fit.linear.clone();
    let old = fit.grid.len();
    let mut f = Vec::with_capacity(grid.len() + p.f.len() - old);
    for s in 0..2 {
        let knots = &grid.knots[s];
        for (i, &v) in knots.iter().enumerate() {
            // The right end of a jump takes the value just above it.
            let at = if i > 0 && knots[i - 1] == v { v + 1e-9 } else { v };
            f.push(fit.grid.hat(s, at).iter().map(|&(j, w)| w * p.f[j]).sum());
        }
    }
    f.extend(&p.f[old..]);
    p.f = f;
    p
}
