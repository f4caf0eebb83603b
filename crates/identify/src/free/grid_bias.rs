//! What straight lines between knots leave out, estimated from the bends at the knots.

use super::basis::Basis;
use super::normalise::{Covariance, quantities};
use super::problem::Parameters;
use super::units::OutputUnits;
use nalgebra::{DMatrix, DVector};

/// The bias of a fit on a grid of knots whose two borders bend between them.
///
/// In a cell of width `h` a chord misses a curve `F` by `F″x(h−x)/2`. With `δ` what the chords miss at the middle of every cell, `I` the information
/// matrix on the grid with all cells halved, and `E` the embedding of the fit's parameters in the halved grid's, least squares is off by
///
/// ```text
/// bias = (EᵀIE)⁻¹ EᵀI δ,    δ = −F″h²/6
/// ```
///
/// to first order in `δ`. (A hat of height `h²/6` has the mean of the parabola, `h²/12`; on evenly visited knots the bias is then `−F″h²/12` at all of them.) `F″` in
/// a cell is the mean of the second divided differences at its two ends, or the one there is. Every normalised parameter follows by the
/// delta method.
///
/// The estimate is a linear function of the fit, so that it has a standard error of its own, about a quarter of the parameter's.
#[derive(Debug)]
pub(super) struct GridBias {
    /// Of `a`, `b`, the descending border and the ascending one.
    parameters: Vec<Uncertain>,
    /// Number of coefficients before the points.
    coefficients: usize,
    /// Of `(a, b, f, c)`, where both borders have three knots or more and it is finite.
    change: Option<DVector<f64>>,
}

/// One parameter: how far noise and the grid may put it off.
#[derive(Debug, Clone, Copy)]
struct Uncertain {
    /// Standard error by noise.
    se: f64,
    /// Estimated bias by the grid.
    bias: f64,
    /// Standard error of that estimate.
    bias_se: f64,
    /// Standard error by noise of the parameter less its estimated bias.
    corrected_se: f64,
}

impl Uncertain {
    /// The squared bias, less what noise adds to its estimate: unbiased, and so of either sign.
    fn square(self) -> f64 {
        self.bias * self.bias - self.bias_se * self.bias_se
    }

    /// `√(se² + bias²)` of the corrected parameter, which is off by no more than the correction wherever that is of the right sign and at
    /// most twice too large.
    fn error(self) -> f64 {
        (self.corrected_se * self.corrected_se + self.square().max(0.0)).sqrt()
    }
}

impl GridBias {
    /// Of a fit with the given covariance, of what it shows in some units; `information` is that of the same fit on its halved grid.
    pub(super) fn of(
        theta: &Parameters,
        basis: &Basis,
        covariance: &Covariance,
        information: &DMatrix<f64>,
        units: OutputUnits,
    ) -> Self {
        let coefficients = theta.a.len() + theta.b.len();
        let missed = missed_by_chords(basis);
        // From the derivatives of a quantity to those of its bias.
        let derivatives_of_bias = |derivative: &DVector<f64>| {
            let change = information * embedded(&covariance.response(derivative), coefficients, basis);
            let mut response = DVector::zeros(derivative.len());
            for (middle, weights) in &missed {
                for &(knot, weight) in weights.iter().filter(|(knot, _)| *knot > 0) {
                    response[coefficients + knot - 1] += change[coefficients + middle - 1] * weight;
                }
            }
            response
        };
        let at_the_fit = |response: &DVector<f64>| -> f64 {
            theta.f.iter().enumerate().map(|(k, f)| f * response[coefficients + k]).sum()
        };
        let is_judged = basis.descending().len().min(basis.ascending().len()) > 2;
        let size = coefficients + theta.f.len() + 1;
        let change = DVector::from_fn(size, |i, _| {
            let unit = DVector::from_fn(size, |j, _| f64::from(u8::from(i == j)));
            at_the_fit(&derivatives_of_bias(&unit))
        });
        let change = Some(change).filter(|change| is_judged && change.iter().all(|x| x.is_finite()));
        let parameter = |derivative: &DVector<f64>| {
            let response = derivatives_of_bias(derivative);
            let corrected = if change.is_some() { derivative - &response } else { derivative.clone() };
            let [se, bias_se, corrected_se] =
                [derivative, &response, &corrected].map(|d| covariance.standard_error(d));
            Uncertain { se, bias: at_the_fit(&response), bias_se, corrected_se }
        };
        let parameters = quantities(theta, basis, units).iter().map(|q| parameter(&q.derivative)).collect();
        Self { parameters, coefficients, change }
    }

    /// Root mean square of the bias in standard errors, over the coefficients or over the points, whichever is larger; infinite where a border has
    /// no bend to judge by or a parameter no finite error.
    pub(super) fn in_errors(&self) -> f64 {
        let rms = |parameters: &[Uncertain]| {
            let sum: f64 = parameters.iter().map(|p| p.square() / (p.se * p.se)).sum();
            (sum / parameters.len() as f64).max(0.0).sqrt()
        };
        let (coefficients, points) = self.parameters.split_at(self.coefficients);
        let worst = rms(coefficients).max(rms(points));
        if self.change.is_some() && worst.is_finite() { worst } else { f64::INFINITY }
    }

    /// The fit less its bias; as it is where the bends do not show one.
    pub(super) fn taken_off(&self, theta: &Parameters) -> Parameters {
        match &self.change {
            Some(change) => theta.moved((-change).as_slice()),
            None => theta.clone(),
        }
    }

    /// Standard errors of the fit less its bias, with the bias in them.
    pub(super) fn errors(&self) -> impl Iterator<Item = f64> {
        self.parameters.iter().map(|p| p.error())
    }
}

/// For the middle of every cell, by its number among the knots of the halved grid, what the chord misses there, as weights on knots; nothing
/// where a curve has no bend to judge by.
fn missed_by_chords(basis: &Basis) -> Vec<(usize, Vec<(usize, f64)>)> {
    let (mut all, mut first, mut first_half) = (Vec::new(), 0, 0);
    for knots in [basis.descending(), basis.ascending()] {
        let width = |k: usize| knots[k + 1] - knots[k];
        for k in 0..knots.len() - 1 {
            let ends = [k, k + 1].into_iter().filter(|&j| j > 0 && j + 1 < knots.len());
            let share = -width(k).powi(2) / 6.0 / ends.clone().count() as f64;
            let second = |j: usize| {
                let (left, right) = (width(j - 1), width(j));
                let scale = share * 2.0 / (left + right);
                [(j - 1, scale / left), (j, -scale * (1.0 / left + 1.0 / right)), (j + 1, scale / right)]
            };
            let weights = ends.flat_map(second).map(|(j, weight)| (first + j, weight)).collect();
            all.push((first_half + 2 * k + 1, weights));
        }
        first += knots.len();
        first_half += 2 * knots.len() - 1;
    }
    all
}

/// A change of `(a, b, f, c)` as one of the same parameters on the halved grid.
fn embedded(change: &DVector<f64>, coefficients: usize, basis: &Basis) -> DVector<f64> {
    let value = |knot: usize| if knot == 0 { 0.0 } else { change[coefficients + knot - 1] };
    let mut values: Vec<f64> = change.as_slice()[..coefficients].to_vec();
    let mut first = 0;
    for knots in [basis.descending(), basis.ascending()] {
        for k in first..first + knots.len() {
            values.push(value(k));
            if k + 1 < first + knots.len() {
                values.push(0.5 * (value(k) + value(k + 1)));
            }
        }
        first += knots.len();
    }
    // The reference knot has no feature.
    values.remove(coefficients);
    values.push(change[change.len() - 1]);
    DVector::from_vec(values)
}

#[cfg(test)]
mod tests {
    use super::super::errors::Errors;
    use super::super::fit::equation_error_fit;
    use super::super::one_shot::Grid;
    use super::super::problem::Structure;
    use super::super::rank_one::information;
    use super::super::regression::Regression;
    use super::*;
    use crate::excitation::RandomLevels;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use switchback_model::hysteresis::{Branch, General, Interval, SaturatingCurve, SwitchedHysteresis};
    use switchback_model::linear::{autocovariance, filter};
    use switchback_model::reversal::ReversalRule;

    #[test]
    fn the_bias_estimated_is_that_of_the_limit() {
        let (a, b, samples, variance) = ([-1.2, 0.45], [0.15, 0.1], 4000, 1e-4);
        let interval = Interval::new(-1.0, 1.0).unwrap();
        let v = RandomLevels::new(interval).record_input(samples + 5, &mut ChaCha8Rng::seed_from_u64(7));
        let up = SaturatingCurve {
            offset: 0.1,
            amplitude: 0.7,
            centre: 0.3,
            width: 0.6,
            slope: 0.2,
            curvature: 0.3,
        };
        let down = SaturatingCurve { offset: -0.3, centre: -0.2, ..up };
        let borders = Box::new(General::new(up, down).unwrap());
        let hysteresis = SwitchedHysteresis::new(interval, borders).unwrap();
        let u = hysteresis.output(&v, hysteresis.u_low());
        let z = filter(&a, &b, &u, &[], hysteresis.u_low(), hysteresis.u_low());
        let knots: Vec<f64> = (0..17).map(|j| -1.0 + 0.125 * f64::from(j)).collect();
        let structure = Structure { order: 2, delay: 0 };
        let basis = Basis::borders(knots.clone(), knots);
        let gamma = autocovariance(&a, &[], 2);
        let expected = |basis: &Basis| {
            let grid = Grid { structure, basis: basis.clone(), rule: ReversalRule::EXACT };
            let regression = Regression::unchecked(&v, grid, &[samples]).unwrap();
            let noise =
                DMatrix::from_fn(3, 3, |i, j: usize| samples as f64 * variance * gamma[i.abs_diff(j)]);
            let lags = &regression.lag_products(&z, &z)[0] + noise;
            regression.moments(0, &lags, &regression.input_products(&z)[0])
        };
        let (moments, halved) = (expected(&basis), basis.halved());
        let theta = equation_error_fit(&moments).unwrap();
        let covariance = Errors::of_equation(&moments, &theta).covariance.unwrap();
        let on_halved = information(&expected(&halved), &theta.on_basis(&basis, &halved));
        let estimated = GridBias::of(&theta, &basis, &covariance, &on_halved, OutputUnits::OWN);
        let mut truth = vec![a[0], a[1], b[0] * hysteresis.span(), b[1] * hysteresis.span()];
        for (branch, knots) in
            [(Branch::Descending, basis.descending()), (Branch::Ascending, basis.ascending())]
        {
            truth.extend(knots.iter().map(|&v| hysteresis.border(branch, v) / hysteresis.span()));
        }
        let (mut energy, mut missed) = (0.0, 0.0);
        for ((quantity, truth), estimated) in
            quantities(&theta, &basis, OutputUnits::OWN).iter().zip(&truth).zip(&estimated.parameters).skip(4)
        {
            energy += (quantity.value - truth).powi(2);
            missed += (quantity.value - truth - estimated.bias).powi(2);
        }
        // The next term of the expansion is smaller by h² ≈ 1/64 times curvatures of the curvature.
        assert!(missed.sqrt() < 0.25 * energy.sqrt(), "{} of {}", missed.sqrt(), energy.sqrt());
    }
}
