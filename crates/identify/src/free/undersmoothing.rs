//! Intervals that hold the truth of borders that no grid of knots holds.
//!
//! A table of knots cannot follow a border that bends between them, and no standard error says so. The grid that predicts best leaves a
//! bias about as large as the noise. So, for intervals, the grid is refined beyond it (undersmoothing), until what is left of the bias is
//! small against the noise:
//!
//! 1. Every cell is halved that the input visits on both halves, again and again.
//! 2. The first of these grids is taken on which the bias, estimated from the bends at the knots, is below a third of the standard error in root
//!    mean square; or the last before a halving that does not lower this share any more, since noise alone decides from there on.
//! 3. The bias that is left is taken off, with the noise of its estimate in the standard error (a robust bias correction: S. Calonico, M. D. Cattaneo and
//!    R. Titiunik, Econometrica 82 (2014), doi 10.3982/ECTA11757). Uncorrected, a bias of up to a third of the standard error would stay at every `N`.
//! 4. The correction itself joins the standard error: `√(se² + bias²)`, since where the border bends faster than the knots follow, it may do nothing or too
//!    much. Within 1.96 of these lies the truth with at least 95 % as long as the correction is off by no more than its own size: the 95 % quantile of
//!    `|N(b, 1)|`, which the shortest such intervals take, is never above `1.96·√(1 + b²)` (T. B. Armstrong and M. Kolesár, Econometrica 86 (2018),
//!    doi 10.3982/ECTA14434).
//! 5. A jump bends in no way that knots could follow. Where a cell is found to hold one, the points up to one cell beside it get an interval
//!    that spans both sides: `1.96 se` is at least the largest rise to a neighbouring knot. A jump below the noise of the grid is
//!    not found, and a point beside it may miss its truth. A corner counts as a bend, or as a jump where it stands out: intervals beside it
//!    are too wide rather than too narrow, even where a knot lies on the corner.
//!
//! The estimate is reported at the knots of the first grid.

use super::basis::Basis;
use super::doubt::is_ill_conditioned;
use super::errors::Errors;
use super::grid_bias::GridBias;
use super::jumps::rises_at_jumps;
use super::normalise::{Covariance, Figures, level_errors, normalise};
use super::problem::{Parameters, Structure};
use super::units::OutputUnits;
use crate::border_distance::joint_limit;
use crate::{BorderPoint, Estimate, LevelErrors};
use nalgebra::DMatrix;

/// A fit on one of the grids.
#[derive(Debug)]
pub(super) struct GridFit {
    pub(super) basis: Basis,
    pub(super) theta: Parameters,
    pub(super) errors: Errors,
    /// The information matrix of the same fit on its halved grid, per unit noise variance.
    pub(super) halved_information: DMatrix<f64>,
    /// Coefficients of the filter that makes its errors white; none where they are taken as they are.
    pub(super) whitening: Vec<f64>,
}

impl GridFit {
    fn bias(&self, covariance: &Covariance, units: OutputUnits) -> GridBias {
        GridBias::of(&self.theta, &self.basis, covariance, &self.halved_information, units)
    }
}

/// An estimate whose intervals allow for the grid.
#[derive(Debug)]
pub(super) struct Undersmoothed {
    pub(super) estimate: Estimate,
    pub(super) level_errors: LevelErrors,
    /// The fit that it comes from.
    pub(super) fit: GridFit,
    /// The first grid, at whose knots it is reported.
    coarsest: Basis,
}

/// Share of the standard error that the bias may reach: a plain 95 % interval then still holds the truth with 93.7 %.
const SMALL: f64 = 1.0 / 3.0;

/// The estimate from fits on ever finer grids, reported at the knots of the first; `None` if that leaves a parameter open. `figures` are those of
/// the first fit, and stay but for the noise.
pub(super) fn undersmoothed(
    structure: Structure,
    figures: Figures,
    fits: impl Iterator<Item = GridFit>,
) -> Option<Undersmoothed> {
    let mut best: Option<(GridFit, GridBias)> = None;
    let mut coarsest = None;
    for fit in fits {
        let Some(covariance) = &fit.errors.covariance else { break };
        if is_ill_conditioned(&fit.errors.information, &fit.theta) && best.is_some() {
            break;
        }
        coarsest.get_or_insert_with(|| fit.basis.clone());
        // Judged on the centred output: how well the level is known beside an origin far away is no matter of the grid.
        let bias = fit.bias(covariance, OutputUnits::OWN);
        if best.as_ref().is_some_and(|(_, before)| bias.in_errors() >= before.in_errors()) {
            break;
        }
        let is_small = bias.in_errors() <= SMALL;
        best = Some((fit, bias));
        if is_small {
            break;
        }
    }
    let ((fit, _), coarsest) = (best?, coarsest?);
    let (estimate, level_errors) = reported(&fit, structure, &coarsest, figures)?;
    Some(Undersmoothed { estimate, level_errors, fit, coarsest })
}

/// What a fit shows at the knots of a coarser grid; the noise is its own.
fn reported(
    fit: &GridFit,
    structure: Structure,
    coarsest: &Basis,
    figures: Figures,
) -> Option<(Estimate, LevelErrors)> {
    let covariance = fit.errors.covariance.as_ref()?;
    let figures = Figures { noise_sd: fit.errors.variance.sqrt(), ..figures };
    let bias = fit.bias(covariance, figures.units);
    let theta = bias.taken_off(&fit.theta);
    let mut estimate = normalise(&theta, structure, &fit.basis, Some(covariance), figures);
    set_errors(&mut estimate, &bias, &rises_at_jumps(&fit.theta, &fit.basis, covariance));
    keep_knots(&mut estimate.descending, coarsest.descending());
    keep_knots(&mut estimate.ascending, coarsest.ascending());
    Some((estimate, level_errors(&theta, covariance, figures.units)))
}

/// Puts the bias, and the rises at jumps, into the standard errors.
fn set_errors(estimate: &mut Estimate, bias: &GridBias, rises: &[f64]) {
    let mut errors = bias.errors();
    for (se, error) in estimate.a_se.iter_mut().chain(&mut estimate.b_se).zip(&mut errors) {
        *se = error;
    }
    let points = estimate.descending.iter_mut().chain(&mut estimate.ascending);
    for ((point, error), rise) in points.zip(errors).zip(rises) {
        point.se = error.max(rise / joint_limit(1));
    }
}

impl Undersmoothed {
    /// Whether an efficient estimate of the same system differs from this one by no more than this one's errors allow, all parameters at once: the
    /// variance of the difference is this one's less the other's. Both see the centred output.
    pub(super) fn is_compatible_with(
        &self,
        efficient: &Self,
        structure: Structure,
        figures: Figures,
    ) -> bool {
        let figures = Figures { units: OutputUnits::OWN, ..figures };
        let centred = |found: &Self| {
            let (e, _) = reported(&found.fit, structure, &found.coarsest, figures)?;
            let coefficients: Vec<(f64, f64)> =
                e.a.iter().zip(&e.a_se).chain(e.b.iter().zip(&e.b_se)).map(|(x, se)| (*x, *se)).collect();
            let points = e.descending.iter().chain(&e.ascending).map(|p| (p.f, p.se));
            Some(coefficients.into_iter().chain(points).collect::<Vec<_>>())
        };
        let (Some(own), Some(other)) = (centred(self), centred(efficient)) else { return false };
        let limit = joint_limit(own.len());
        own.len() == other.len()
            && own.iter().zip(&other).all(|((x, se), (y, _))| (x - y).abs() <= limit * se)
    }
}

/// Drops the points between the knots of a coarser grid.
fn keep_knots(points: &mut Vec<BorderPoint>, coarse: &[f64]) {
    points.retain(|point| coarse.contains(&point.v));
}

#[cfg(test)]
mod tests {
    use statrs::distribution::{ContinuousCDF, Normal};

    #[test]
    fn the_root_of_the_mean_square_covers_whatever_the_bias() {
        let normal = Normal::standard();
        for bias in (0..500).map(|k| 0.01 * f64::from(k)) {
            let half = 1.959_964 * f64::sqrt(1.0 + bias * bias);
            let covered = normal.cdf(half - bias) - normal.cdf(-half - bias);
            assert!(covered >= 0.95 - 1e-7, "{covered} at a bias of {bias} standard errors");
        }
        let third = normal.cdf(1.96 - super::SMALL) - normal.cdf(-1.96 - super::SMALL);
        assert!((third - 0.937).abs() < 5e-4);
    }
}
