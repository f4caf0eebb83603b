//! How well a structure predicts blocks of time that it was not fitted to.

use super::data::Featured;
use super::fit::{Fitted, Ladder};
use super::problem::{Segment, Structure};
use super::progress::Progress;
use super::simulation_error::Effort;
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
    /// Fit over all left-out blocks; negative infinity if no stable model fits, or the rest of a fold is too short for it.
    pub(super) fit_percent: f64,
    /// Squared simulation error over each left-out block, as a share of the energy of all.
    pub(super) losses: Vec<f64>,
    /// Fits to the rest of each fold.
    pub(super) fits: Vec<Fitted>,
}

/// Cross-validates structures at the top of a ladder, smaller ones first; a piece of work is a fold.
pub(super) fn assess_all(
    ladder: &Ladder,
    structures: &[Structure],
    refine: bool,
    progress: &dyn Progress,
) -> Vec<Assessed> {
    let folds = (0..FOLDS).map(|fold| {
        let fits = if refine {
            ladder.climb_all(structures, Effort::SEARCH, |rung, s| blocks(rung, s, fold, false))
        } else {
            let one_shot = |&s| ladder.one_shot(s, &blocks(ladder.top(), s, fold, false));
            structures.iter().map(one_shot).collect()
        };
        progress.did_one();
        fits
    });
    let folds: Vec<Vec<Option<Fitted>>> = folds.collect();
    let fits = |i: usize| folds.iter().map(|fold: &Vec<Option<Fitted>>| fold[i].clone()).collect();
    structures.iter().enumerate().map(|(i, &structure)| judge(ladder, structure, fits(i))).collect()
}

/// Cross-validates the structure of an earlier assessment on another basis, from the fits that it found.
pub(super) fn assess_next(ladder: &Ladder, earlier: &Assessed, refine: bool) -> Assessed {
    let structure = earlier.structure;
    let fit = |fold: usize| {
        let rest = |rung| blocks(rung, structure, fold, false);
        if refine {
            ladder.climb(structure, Effort::SEARCH, &earlier.fits[fold..=fold], rest)
        } else {
            ladder.one_shot(structure, &rest(ladder.top()))
        }
    };
    judge(ladder, structure, (0..FOLDS).map(fit).collect())
}

/// The errors of each fold's fit over the block it had not seen.
fn judge(ladder: &Ladder, structure: Structure, fits: Vec<Option<Fitted>>) -> Assessed {
    let basis = &ladder.top().basis;
    let mut assessed = Assessed {
        structure,
        knots: basis.sizes().max().unwrap_or(0),
        parameters: structure.order + structure.numerator() + basis.features(),
        fit_percent: f64::NEG_INFINITY,
        losses: Vec::with_capacity(FOLDS),
        fits: fits.into_iter().flatten().collect(),
    };
    let long_enough =
        |fold| basis.check_length(structure, &blocks(ladder.top(), structure, fold, false)).is_ok();
    if assessed.fits.len() < FOLDS || !(0..FOLDS).all(long_enough) {
        return assessed;
    }
    let mut energy = 0.0;
    for (fold, fitted) in assessed.fits.iter().enumerate() {
        let left_out = blocks(ladder.top(), structure, fold, true);
        assessed.losses.push(cost(structure, &fitted.theta, &left_out));
        energy += left_out.iter().map(Segment::energy).sum::<f64>();
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
