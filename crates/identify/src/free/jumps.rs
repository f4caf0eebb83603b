//! Jumps inside the cells of a grid.

use super::basis::Basis;
use super::normalise::{Covariance, Quantity, quantities};
use super::problem::Parameters;
use super::units::OutputUnits;
use crate::border_distance::joint_limit;
use nalgebra::DVector;

/// For every knot of two borders, the largest rise to a neighbouring knot where a cell that holds a jump is no more than one cell away, and 0
/// elsewhere; in the normalisation `u_M − u_m = 1`.
///
/// A cell holds a jump where its rise differs beyond noise from what its neighbours' slopes make of its width `h`, by Bonferroni's limit over
/// all cells. A smooth border differs by about `h³F‴/2`, which is small beside its bend `h²F″` on every grid that follows it. The first and
/// the last cell have no neighbours to be judged by.
pub(super) fn rises_at_jumps(theta: &Parameters, basis: &Basis, covariance: &Covariance) -> Vec<f64> {
    let all = quantities(theta, basis, OutputUnits::OWN);
    let points = &all[theta.a.len() + theta.b.len()..];
    let limit = joint_limit(points.len() - 2);
    let (descending, ascending) = points.split_at(basis.descending().len());
    let borders = [(basis.descending(), descending), (basis.ascending(), ascending)];
    let rises = borders.map(|(knots, points)| {
        let last = knots.len() - 1;
        let jumps: Vec<usize> = (1..last.saturating_sub(1))
            .filter(|&cell| {
                let (excess, derivative) = excess_rise(knots, points, cell);
                excess.abs() > limit * covariance.standard_error(&derivative)
            })
            .collect();
        let rise = |cell: usize| (points[cell + 1].value - points[cell].value).abs();
        let at = |knot: usize| {
            // Jump cell c has the knots c and c + 1; one cell further are c − 1 and c + 2.
            let is_near = jumps.iter().any(|&cell| (cell..cell + 4).contains(&(knot + 1)));
            if is_near { rise(knot.max(1) - 1).max(rise(knot.min(last - 1))) } else { 0.0 }
        };
        (0..=last).map(at).collect::<Vec<_>>()
    });
    rises.concat()
}

/// The rise of a cell less what the mean slope of its two neighbours makes of its width, with its derivative in `(a, b, f, c)`.
fn excess_rise(knots: &[f64], points: &[Quantity], cell: usize) -> (f64, DVector<f64>) {
    let width = |cell: usize| knots[cell + 1] - knots[cell];
    let beside = |other: usize| (other, -0.5 * width(cell) / width(other));
    let (mut value, mut derivative) = (0.0, DVector::zeros(points[0].derivative.len()));
    for (cell, weight) in [beside(cell - 1), (cell, 1.0), beside(cell + 1)] {
        value += weight * (points[cell + 1].value - points[cell].value);
        derivative.axpy(weight, &points[cell + 1].derivative, 1.0);
        derivative.axpy(-weight, &points[cell].derivative, 1.0);
    }
    (value, derivative)
}
