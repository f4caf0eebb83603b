//! How well a structure predicts blocks of time that it was not fitted to.

use super::data::Featured;
use super::fit::Fitted;
use super::problem::{Parameters, Segment, Structure};
use super::rank_one::solve_symmetric;
use super::simulation_error::{
    Effort, Linearised, Refinement, SMOOTHNESS, cost, fix_gauge, linearise_whitened, output_energy, penalty,
};
use nalgebra::{DMatrix, DVector};

/// A structure, its fit to all blocks, and the error of each block under a fit to the others.
#[derive(Debug, Clone)]
pub(super) struct Assessed {
    pub(super) fitted: Fitted,
    /// Knots of each curve.
    pub(super) knots: usize,
    /// Free parameters.
    pub(super) parameters: usize,
    /// Fit over all left-out blocks; negative infinity if a block's fit has no free run, or the rest of a block is too short for it.
    pub(super) fit_percent: f64,
    /// Squared simulation error over each left-out block, as a share of the energy of all.
    pub(super) losses: Vec<f64>,
}

impl Assessed {
    pub(super) fn structure(&self) -> Structure {
        self.fitted.structure
    }
}

/// Leave-one-block-out errors of a fit to all blocks.
///
/// The fit without a block is one Gauss–Newton step away from the fit `θ` to all: with the information `H_k` and the gradient `g_k` of block `k`,
///
/// ```text
/// θ₋ₖ = θ + (Σ_{j≠k} H_j + P)⁻¹ (Σ_{j≠k} g_j − P f)
/// ```
///
/// up to the curvature of the model over the step, which is of the order of the parameters' errors (D. A. Belsley, E. Kuh, R. E. Welsch, Regression
/// Diagnostics, 1980, §2.1; for nonlinear least squares D. Ross, The Canadian Journal of Statistics 15 (1987), doi 10.2307/3315198). One
/// linearisation serves all blocks. Where the step does not lower the error of the other blocks the curvature matters, and the fit is made anew.
pub(super) fn assess(featured: &Featured, fitted: Fitted, blocks: &[Segment]) -> Assessed {
    let (structure, basis) = (fitted.structure, &featured.basis);
    let mut assessed = Assessed {
        knots: basis.sizes().max().unwrap_or(0),
        parameters: structure.order + structure.numerator() + basis.features(),
        fit_percent: f64::NEG_INFINITY,
        losses: Vec::new(),
        fitted,
    };
    let is_long_enough = |k: usize| basis.check_length(structure, &without(blocks, k)).is_ok();
    if blocks.len() < 2 || !(0..blocks.len()).all(is_long_enough) {
        return assessed;
    }
    let theta = &assessed.fitted.theta;
    let curves: Vec<usize> = basis.sizes().collect();
    let penalty = penalty(&curves, theta.f.len()) * (SMOOTHNESS * output_energy(blocks));
    let sums: Vec<Linearised> =
        blocks.iter().map(|block| linearise_whitened(structure, theta, &[*block], &[])).collect();
    let all = Total::of(&sums, theta, &penalty);
    let refinement = Refinement::new(Effort::SEARCH, &curves);
    let energy: f64 = blocks.iter().map(Segment::energy).sum();
    let left_out_error = |k: usize| {
        let rest = without(blocks, k);
        let step = all.without(&sums[k], theta);
        let is_better = |step: &Parameters| cost(structure, step, &rest) <= cost(structure, theta, &rest);
        let fit = step.filter(is_better).unwrap_or_else(|| refinement.run(structure, theta.clone(), &rest));
        cost(structure, &fit, &blocks[k..=k]) / energy
    };
    assessed.losses = (0..blocks.len()).map(left_out_error).collect();
    assessed.fit_percent = 100.0 * (1.0 - assessed.losses.iter().sum::<f64>().sqrt());
    assessed
}

/// All blocks but one.
fn without<'a>(blocks: &[Segment<'a>], k: usize) -> Vec<Segment<'a>> {
    [&blocks[..k], &blocks[k + 1..]].concat()
}

/// Gauss–Newton sums of all blocks, the penalty on rough curves included.
struct Total {
    information: DMatrix<f64>,
    gradient: DVector<f64>,
}

impl Total {
    fn of(sums: &[Linearised], theta: &Parameters, penalty: &DMatrix<f64>) -> Self {
        let mut information =
            sums.iter().fold(DMatrix::zeros(sums[0].gradient.len(), sums[0].gradient.len()), |sum, block| {
                sum + &block.information
            });
        let mut gradient =
            sums.iter().fold(DVector::zeros(sums[0].gradient.len()), |sum, block| sum + &block.gradient);
        let first = theta.a.len() + theta.b.len();
        let mut curves = information.view_mut((first, first), penalty.shape());
        curves += penalty;
        let mut pull = gradient.rows_mut(first, theta.f.len());
        pull -= penalty * DVector::from_column_slice(&theta.f);
        fix_gauge(&mut information, theta);
        Self { information, gradient }
    }

    /// The parameters that fit all blocks but one.
    fn without(&self, block: &Linearised, theta: &Parameters) -> Option<Parameters> {
        let information = &self.information - &block.information;
        let step = solve_symmetric(&information, &(&self.gradient - &block.gradient), 1e-12)?;
        Some(theta.moved(step.as_slice()))
    }
}
