//! The measure of an error: filtered, and robust.

use switchback_model::noise_model::{noise_model, whitened};

/// `Σ ρ(e/σ)` of filtered errors, with Huber's `ρ(x) = x²` for `|x| ≤ k`, `2k|x| − k²` beyond.
///
/// P. J. Huber, Ann. Math. Statist. 35 (1964), doi 10.1214/aoms/1177703732. At `k = 3` a normal error loses 0.5 % of its efficiency.
#[derive(Debug, Clone, PartialEq)]
pub struct Criterion {
    /// Coefficients of `D(q⁻¹) = 1 + d₁q⁻¹ + …`; none where errors count as they are.
    pub filter: Vec<f64>,
    /// Standard deviation of the filtered errors.
    pub sd: f64,
}

/// Standard deviations beyond which an error counts less than its square.
const TURN: f64 = 3.0;

/// `Φ⁻¹(¾)`: the median of the absolute value of a standard normal variable.
const MEDIAN_OF_NORMAL: f64 = 0.674_489_750_196_081_7;

impl Criterion {
    /// The criterion under which these errors are white, one list a record. Far errors are drawn in before the filter is estimated.
    pub fn of(errors: &[Vec<f64>]) -> Self {
        let spread = robust_sd(errors.iter().flatten().copied());
        let drawn: Vec<Vec<f64>> =
            errors.iter().map(|e| e.iter().map(|x| x.clamp(-5.0 * spread, 5.0 * spread)).collect()).collect();
        let filter = if spread > 0.0 { noise_model(&drawn) } else { Vec::new() };
        let white: Vec<Vec<f64>> = errors.iter().map(|e| whitened(e.clone(), &filter)).collect();
        Self { sd: robust_sd(white.iter().flatten().copied()), filter }
    }

    /// The filtered signal.
    pub fn filtered(&self, x: Vec<f64>) -> Vec<f64> {
        whitened(x, &self.filter)
    }

    /// The weight of a filtered error in an iteratively reweighted least-squares problem.
    pub(super) fn weight(&self, e: f64) -> f64 {
        let x = (e / self.sd).abs();
        if x > TURN { TURN / x } else { 1.0 }
    }

    /// The filtered error as far as it counts by its square: `e` drawn in to `±kσ`, half the derivative of `σ²ρ(e/σ)`.
    pub(super) fn drawn_in(&self, e: f64) -> f64 {
        e.clamp(-TURN * self.sd, TURN * self.sd)
    }

    /// `ρ(e/σ)`.
    pub(super) fn loss(&self, e: f64) -> f64 {
        let x = (e / self.sd).abs();
        if x > TURN { 2.0 * TURN * x - TURN * TURN } else { x * x }
    }
}

/// The standard deviation of the normal distribution with this median of absolute values; the root mean square where that is zero.
fn robust_sd(values: impl Iterator<Item = f64>) -> f64 {
    let mut sizes: Vec<f64> = values.map(f64::abs).collect();
    if sizes.is_empty() {
        return 0.0;
    }
    let middle = sizes.len() / 2;
    let median = *sizes.select_nth_unstable_by(middle, f64::total_cmp).1;
    if median > 0.0 {
        return median / MEDIAN_OF_NORMAL;
    }
    (sizes.iter().map(|x| x * x).sum::<f64>() / sizes.len() as f64).sqrt()
}
