//! What the errors of a fit say against it.

use super::basis::Basis;
use super::normalise::{Covariance, Quantity, quantities, scaled_information};
use super::problem::{Parameters, Structure};
use super::units::OutputUnits;
use super::warning::Warning;
use crate::border_distance::{BorderDistance, BorderGap, joint_limit};
use nalgebra::{DMatrix, DVector};
use switchback_model::hysteresis::Branch;

/// A fit with its information and its errors.
#[derive(Debug)]
pub(super) struct Doubt<'a> {
    pub(super) structure: Structure,
    pub(super) basis: &'a Basis,
    pub(super) theta: &'a Parameters,
    /// Per unit noise variance.
    pub(super) information: &'a DMatrix<f64>,
    /// None if a parameter has no information.
    pub(super) covariance: Option<&'a Covariance>,
    /// What numbers are reported in.
    pub(super) units: OutputUnits,
}

/// A number and its standard error.
#[derive(Debug, Clone, Copy)]
struct Known {
    value: f64,
    se: f64,
}

impl Known {
    fn is_distinguished_from_zero(self, limit: f64) -> bool {
        self.value.abs() > limit * self.se
    }
}

/// Condition number from which on the normal equations lose half of the sixteen digits of double precision: `1/√ε`.
const HALF_OF_THE_DIGITS: f64 = 67_108_864.0;

impl Doubt<'_> {
    /// How far the borders lie apart; `None` for a model of one curve, or without errors.
    pub(super) fn distance(&self) -> Option<BorderDistance> {
        let covariance = self.covariance.filter(|_| self.basis.is_switched())?;
        // Differences of the borders know no origin.
        let all = quantities(self.theta, self.basis, OutputUnits::OWN);
        let points = &all[self.theta.a.len() + self.theta.b.len()..];
        let mut places: Vec<f64> =
            self.basis.descending().iter().chain(self.basis.ascending()).copied().collect();
        places.sort_by(f64::total_cmp);
        places.dedup();
        let gap = |v: f64| {
            let ascending = self.basis.place(Branch::Ascending, v).hats().map(|(k, x)| (k, x));
            let descending = self.basis.place(Branch::Descending, v).hats().map(|(k, x)| (k, -x));
            let difference = combined(points, ascending.into_iter().chain(descending), covariance);
            BorderGap {
                v,
                difference: difference.value,
                se: difference.se,
                interpolation: self.interpolation(v, points),
            }
        };
        BorderDistance::of(&places.into_iter().map(gap).collect::<Vec<_>>())
    }

    /// What straight lines between the knots may be off by at `v`, both borders together.
    ///
    /// A line misses a curve by `|F″|h²/8` at most over a cell of width `h`; `F″` is twice the largest second divided difference over three
    /// neighbouring knots of either border. A least-squares line may be as far off at the knots, so the widest cell beside `v` counts.
    fn interpolation(&self, v: f64, points: &[Quantity]) -> f64 {
        let (down, up) = (self.basis.descending(), self.basis.ascending());
        let curvature = |knots: &[f64], points: &[Quantity]| {
            let slope = |k: usize| (points[k + 1].value - points[k].value) / (knots[k + 1] - knots[k]);
            let second = |j: usize| ((slope(j + 1) - slope(j)) / (knots[j + 2] - knots[j])).abs();
            (0..knots.len().saturating_sub(2)).map(second).fold(0.0, f64::max)
        };
        let largest = curvature(down, points).max(curvature(up, &points[down.len()..]));
        let widest = |knots: &[f64]| {
            let beside = knots.windows(2).filter(|cell| cell[0] <= v && v <= cell[1]);
            beside.map(|cell| cell[1] - cell[0]).fold(0.0, f64::max)
        };
        0.25 * largest * (widest(down).powi(2) + widest(up).powi(2))
    }

    /// Everything that the errors say against the fit, hollow coefficients aside.
    pub(super) fn warnings(&self) -> Vec<Warning> {
        let mut found = Vec::new();
        let condition = condition(self.information, self.theta);
        if condition > HALF_OF_THE_DIGITS {
            found.push(Warning::IllConditioned { condition });
        }
        if let Some(covariance) = self.covariance {
            if let Some(distance) = self.distance().filter(BorderDistance::has_vanished) {
                found.push(Warning::LoopVanished { distance });
            }
            self.coefficients(covariance, &mut found);
        }
        found
    }

    /// What of `A` and `B` cannot be distinguished from zero though the model rests on it.
    fn coefficients(&self, covariance: &Covariance, found: &mut Vec<Warning>) {
        let all = quantities(self.theta, self.basis, self.units);
        let (a, rest) = all.split_at(self.theta.a.len());
        let b = &rest[..self.theta.b.len()];
        let ahead = self.structure.ahead();
        // A positive delay shifts the whole of B and leaves the names of its coefficients alone.
        let first_lag = 1 + self.structure.delay.min(0);
        let lead = strongest(&b[..ahead], covariance);
        if let Some((i, known)) =
            lead.filter(|(_, known)| !known.is_distinguished_from_zero(joint_limit(ahead)))
        {
            let lag = first_lag + i as isize;
            found.push(Warning::LeadNotReported { lag, value: known.value, se: known.se });
        }
        let one = |terms: &[Quantity]| combined(terms, (0..terms.len()).map(|i| (i, 1.0)), covariance);
        let (a_one, b_one) = (one(a), one(b));
        let a_one = Known { value: 1.0 + a_one.value, ..a_one };
        for (polynomial, known) in [('A', a_one), ('B', b_one)] {
            if !known.is_distinguished_from_zero(joint_limit(1)) {
                found.push(Warning::GainNotReported { polynomial, value: known.value, se: known.se });
            }
        }
    }
}

/// The coefficient most clearly distinguished from zero.
fn strongest(terms: &[Quantity], covariance: &Covariance) -> Option<(usize, Known)> {
    let known = |q: &Quantity| Known { value: q.value, se: covariance.standard_error(&q.derivative) };
    let z = |k: &Known| k.value.abs() / k.se;
    terms.iter().map(known).enumerate().max_by(|x, y| z(&x.1).total_cmp(&z(&y.1)))
}

/// A combination of quantities with its standard error.
fn combined(
    quantities: &[Quantity],
    weights: impl IntoIterator<Item = (usize, f64)>,
    covariance: &Covariance,
) -> Known {
    let size = quantities.first().map_or(0, |q| q.derivative.len());
    let (mut value, mut derivative) = (0.0, DVector::zeros(size));
    for (i, weight) in weights {
        value += weight * quantities[i].value;
        derivative.axpy(weight, &quantities[i].derivative, 1.0);
    }
    Known { value, se: covariance.standard_error(&derivative) }
}

/// Whether the normal equations lose half of the digits or more.
pub(super) fn is_ill_conditioned(information: &DMatrix<f64>, theta: &Parameters) -> bool {
    condition(information, theta) > HALF_OF_THE_DIGITS
}

/// Largest over smallest eigenvalue of the information matrix with its columns scaled to one, the scale shared by `b` and `f` set aside;
/// infinite if a parameter has no information.
///
/// Scaled so, no choice of units makes it larger (A. van der Sluis, Numer. Math. 14 (1969), doi 10.1007/BF02165096: within a factor of the
/// number of columns this is the least condition number that scaling can give).
fn condition(information: &DMatrix<f64>, theta: &Parameters) -> f64 {
    let Some((scaled, _)) = scaled_information(information, theta) else { return f64::INFINITY };
    let eigenvalues = scaled.symmetric_eigenvalues();
    let smallest = eigenvalues.min();
    if smallest > 0.0 { eigenvalues.max() / smallest } else { f64::INFINITY }
}
