//! The estimate in one shot, on a grid that is known beforehand.

use super::basis::Basis;
use super::cells::Cells;
use super::equation_error::Moments;
use super::error::FreeError;
use super::errors::equation_error_estimate;
use super::fit::equation_error_fit;
use super::problem::{Segment, Structure};
use crate::Estimate;
use switchback_model::record::Record;
use switchback_model::reversal::{Branches, ReversalRule};

/// All that [`one_shot`] takes as known.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// Order and delay.
    pub structure: Structure,
    /// Knots of the curves.
    pub basis: Basis,
    /// What counts as a reversal.
    pub rule: ReversalRule,
}

/// Least squares and rank one on a given grid: no search, no refinement.
///
/// ```text
/// y(t) = −Σᵢ aᵢ y(t−i) + Σᵢₖ bᵢ f_k hat_k(v(t−d−i)) + c + ξ(t)
/// ```
///
/// One pass over the records, `O((n + n_b)²)` a sample, then algebra on the moments. Where the borders are piecewise linear on the
/// grid and `ξ` is white, this is the maximum-likelihood estimate: consistent, at the Cramér–Rao bound of a record of this
/// input, with standard errors by the delta method. Output noise or sensor noise on `v` bias it.
///
/// # Errors
/// [`FreeError`] if the input never moves, a knot has no sample beside it, or there are too few samples.
///
/// ```
/// use switchback_model::Record;
/// use switchback_identify::free::{Basis, Grid, Structure, one_shot};
/// use switchback_model::linear::filter;
/// use switchback_model::reversal::ReversalRule;
/// // A relay of ±1 that drives y(t) = 0.5 y(t−1) + u(t−1).
/// let v: Vec<f64> = (0..200).map(|t| f64::from(t * t % 17)).collect();
/// let mut u = vec![0.0; 200];
/// for t in 1..200 {
///     u[t] = if v[t] == v[t - 1] { u[t - 1] } else { (v[t] - v[t - 1]).signum() };
/// }
/// let y = filter(&[-0.5], &[1.0], &u, &[], 0.0, 0.0);
/// let grid = Grid {
///     structure: Structure { order: 1, delay: 0 },
///     basis: Basis::borders(vec![0.0, 16.0], vec![0.0, 16.0]),
///     rule: ReversalRule::EXACT,
/// };
/// let estimate = one_shot(&[&Record::new(v, y)?], &grid)?;
/// assert!((estimate.a[0] + 0.5).abs() < 1e-9);
/// assert!((estimate.gain - 4.0).abs() < 1e-9); // u_M − u_m = 2, B(1)/A(1) = 2
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn one_shot(records: &[&Record], grid: &Grid) -> Result<Estimate, FreeError> {
    let Grid { structure, ref basis, rule } = *grid;
    if records.is_empty() {
        return Err(FreeError::NoRecords);
    }
    let branches: Vec<_> = records.iter().filter_map(|r| Some((*r, Branches::of(r.v(), rule)?))).collect();
    if branches.is_empty() {
        return Err(FreeError::NoMotion { threshold: rule.threshold });
    }
    let cells: Vec<_> = branches.iter().map(|(r, b)| Cells::of(basis, r.v(), b)).collect();
    let segments: Vec<Segment> = branches
        .iter()
        .zip(&cells)
        .filter_map(|((r, b), cells)| Segment::usable(structure, r.y(), cells, b.first_known()..r.len()))
        .collect();
    basis.check_visits(&segments)?;
    basis.check_length(structure, &segments)?;
    let moments = Moments::of(structure, basis.features(), &segments);
    let theta = equation_error_fit(&moments).ok_or(FreeError::Unstable { order: structure.order })?;
    Ok(equation_error_estimate(&moments, basis, &theta))
}
