//! Regressions of one input on ever finer grids.

use super::equation_error::Moments;
use super::error::FreeError;
use super::errors::{Errors, figures};
use super::fit::quick_equation_error_fit;
use super::halving::Places;
use super::one_shot::Grid;
use super::rank_one::information;
use super::regression::Regression;
use super::undersmoothing::{GridFit, undersmoothed};
use super::units::OutputUnits;
use crate::Estimate;
use switchback_model::reversal::Branches;

/// The regressions of one input on a grid and on ever finer ones that contain it, for estimates whose intervals hold the truth of borders
/// that bend between the knots of any grid.
///
/// The grid is refined until its bias is small against the noise, what is left of the bias joins the standard errors, and a
/// point up to one cell beside a jump that was found gets an interval that spans both sides. The estimate is reported at the knots of the
/// first grid.
#[derive(Debug, Clone)]
pub struct NestedRegressions {
    /// On each grid, and after it on the same with all cells halved, where its bends are judged.
    pub(super) regressions: Vec<Regression>,
}

impl NestedRegressions {
    /// As [`Regression::new`]. The first checkpoint's samples decide which cells the input visits on both halves.
    ///
    /// # Errors
    /// As [`Regression::new`].
    pub fn new(v: &[f64], grid: Grid, checkpoints: &[usize]) -> Result<Self, FreeError> {
        let threshold = grid.rule.threshold;
        let branches = Branches::of(v, grid.rule).ok_or(FreeError::NoMotion { threshold })?;
        let on = |basis| Grid { basis, ..grid.clone() };
        let mut next = Regression::new(v, grid.clone(), checkpoints)?;
        let explained = next.start()..next.start() + checkpoints.first().copied().unwrap_or_default();
        let places = Places::of(&[(v, &branches, explained)]);
        let mut regressions = Vec::new();
        loop {
            let basis = next.grid().basis.clone();
            regressions.push(next);
            regressions.push(Regression::unchecked(v, on(basis.halved()), checkpoints)?);
            let Some(finer) = basis.halved_where_visited(&places, grid.structure.numerator()) else { break };
            match Regression::new(v, on(finer), checkpoints) {
                Ok(regression) => next = regression,
                // Too many knots for the samples, or a knot that none of them is beside.
                Err(FreeError::TooShort { .. } | FreeError::UnvisitedKnot { .. }) => break,
                Err(error) => return Err(error),
            }
        }
        Ok(Self { regressions })
    }

    /// All regressions, in the order of the moments that [`Self::estimate`] asks for.
    pub fn regressions(&self) -> &[Regression] {
        &self.regressions
    }

    /// The regressions on the grids themselves, the given one first, each with its number among all.
    pub fn on_grids(&self) -> impl Iterator<Item = (usize, &Regression)> {
        self.regressions.iter().enumerate().step_by(2)
    }

    /// The estimate at the knots of the first grid. `moments` gives those of the output for the regression of a number; it is asked only for what
    /// is needed.
    ///
    /// # Errors
    /// [`FreeError::NotExcited`] if nothing fits on the first grid, or the samples leave a parameter open there.
    pub fn estimate(&self, moments: impl Fn(usize) -> Moments) -> Result<Estimate, FreeError> {
        let structure = self.regressions[0].grid().structure;
        let fits = self.on_grids().map_while(|(number, regression)| {
            let basis = regression.grid().basis.clone();
            let halved = &self.regressions[number + 1].grid().basis;
            let on_halved = moments(number + 1);
            let moments = moments(number);
            let theta = quick_equation_error_fit(&moments)?;
            let errors = Errors::of_equation(&moments, &theta);
            let halved_information = information(&on_halved, &theta.on_basis(&basis, halved));
            Some(GridFit { basis, theta, errors, halved_information, whitening: Vec::new() })
        });
        let figures = figures(&moments(0), 0.0, OutputUnits::OWN);
        Ok(undersmoothed(structure, figures, fits).ok_or(FreeError::NotExcited)?.estimate)
    }
}
