//! How well a structure predicts blocks of time that it was not fitted to.

use super::data::Featured;
use super::fit::{Effort, Fitted, Ladder};
use super::problem::{Segment, Structure};
use super::simulation_error::cost;

/// Parts that the fit records are cut into; each is left out once.
pub(super) const FOLDS: usize = 4;

/// A structure and what cross-validation says of it.
#[derive(Debug)]
pub(super) struct Assessed {
    pub(super) structure: Structure,
    /// Knots of each curve.
    pub(super) knots: usize,
    /// Free parameters.
    pub(super) parameters: usize,
    /// Fit over all left-out blocks; negative infinity if no stable model fits.
    pub(super) fit_percent: f64,
    /// Squared simulation error over each left-out block, as a share of the energy of all.
    pub(super) losses: Vec<f64>,
    /// Fits to the rest of each fold.
    pub(super) fits: Vec<Fitted>,
}

/// Cross-validates one structure at the top of a ladder, from each fold's earlier fit where there is one.
pub(super) fn assess(
    ladder: &Ladder,
    structure: Structure,
    refine: bool,
    below: Option<&[Fitted]>,
) -> Assessed {
    let basis = &ladder.top().basis;
    let mut assessed = Assessed {
        structure,
        knots: basis.sizes().max().unwrap_or(0),
        parameters: structure.order + structure.numerator() + basis.features(),
        fit_percent: f64::NEG_INFINITY,
        losses: Vec::with_capacity(FOLDS),
        fits: Vec::with_capacity(FOLDS),
    };
    let mut energy = 0.0;
    for fold in 0..FOLDS {
        let rest = |f| blocks(f, structure, fold, false);
        let fitted = if refine {
            ladder.climb(structure, Effort::SEARCH, below.map(|b| &b[fold]), rest)
        } else {
            ladder.one_shot(structure, &rest(ladder.top()))
        };
        let Some(fitted) = fitted else { return assessed };
        let left_out = blocks(ladder.top(), structure, fold, true);
        assessed.losses.push(cost(structure, &fitted.theta, &left_out));
        energy += left_out.iter().map(Segment::energy).sum::<f64>();
        assessed.fits.push(fitted);
    }
    assessed.losses.iter_mut().for_each(|loss| *loss /= energy);
    assessed.fit_percent = 100.0 * (1.0 - assessed.losses.iter().sum::<f64>().sqrt());
    assessed
}

/// The blocks of one fold, or all the others.
fn blocks<'s>(featured: &'s Featured, structure: Structure, fold: usize, inside: bool) -> Vec<Segment<'s>> {
    let all = featured.blocks(structure, FOLDS).into_iter().enumerate();
    all.filter(|(i, _)| (i % FOLDS == fold) == inside).map(|(_, s)| s).collect()
}
