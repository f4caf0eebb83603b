//! The sensor's characteristic, by its inverse.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::model::sensor_polynomial::SensorPolynomial;

/// The inverse characteristic `x = z + Σ θₖ zᵏ⁺² + Σ hⱼ bump((z−cⱼ)/s) + knees(z)`, dimensionless, `z + γ₂z² + γ₃z³ = y`.
///
/// Powers describe a gentle curve, bumps any smooth one, knees a range that ends softly: it is the inverse that is linear in
/// them, and the inverse that the likelihood of `y` needs. Curves that are powers sensor polynomial have no short inverse.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct SensorCurve {
    /// Coefficients `θ` of the inverse: of `y²`, `y³`, ….
    pub(crate) powers: Vec<f64>,
    /// A characteristic that is a polynomial sensor polynomial.
    #[serde(rename = "forwards")]
    pub(crate) sensor_polynomial: Option<SensorPolynomial>,
    /// Bumps.
    pub(crate) bumps: Option<Bumps>,
    /// Ends of the range that are soft.
    pub(crate) knees: Vec<Knee>,
}

/// Evenly spaced bumps `exp(−z²/2)`, `z = (y − first − j·spacing)/spacing`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Bumps {
    /// Where the first is.
    pub(crate) first: f64,
    /// Distance between neighbours, and their width.
    pub(crate) spacing: f64,
    /// Their heights.
    pub(crate) heights: Vec<f64>,
}

/// Beyond `level` the sensor answers to the logarithm of what exceeds it: `x = y + w·(e^z − 1 − z)`, `z` the excess over `w`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Knee {
    /// Where it begins.
    pub(crate) level: f64,
    /// Its width.
    pub(crate) width: f64,
    /// +1 for the upper end of the range, −1 for the lower.
    pub(crate) sign: f64,
}

/// Excess over the width beyond which a knee goes on straight.
pub(crate) const STEEPEST: f64 = 5.0;
/// Slope of an inverse at least where noise is shown: flatter ones are a limit of the range.
const FLATTEST: f64 = 0.05;

impl SensorCurve {
    pub(crate) fn is_straight(&self) -> bool {
        self.powers.is_empty()
            && self.sensor_polynomial.is_none()
            && self.bumps.is_none()
            && self.knees.is_empty()
    }

    /// `x` and `dx/dy` at a reading `y`.
    pub(crate) fn undo(&self, y: f64) -> (f64, f64) {
        let (z, inner) = self.sensor_polynomial.map_or((y, 1.0), |curve| curve.undo(y));
        let (x, slope) = self.undo_inverse(z);
        (x, slope * inner)
    }

    /// The same for what is given by its inverse.
    fn undo_inverse(&self, y: f64) -> (f64, f64) {
        let (mut x, mut slope, mut power) = (y, 1.0, y);
        for (k, c) in self.powers.iter().enumerate() {
            slope += c * (k + 2) as f64 * power;
            power *= y;
            x += c * power;
        }
        if let Some(b) = &self.bumps {
            for (j, h) in b.heights.iter().enumerate() {
                let z = (y - b.first) / b.spacing - j as f64;
                let bump = h * (-0.5 * z * z).exp();
                x += bump;
                slope -= bump * z / b.spacing;
            }
        }
        for knee in &self.knees {
            let excess = knee.sign * (y - knee.level) / knee.width;
            if excess > 0.0 {
                let z = excess.min(STEEPEST);
                let e = z.exp();
                x += knee.sign * knee.width * (e - 1.0 - z + (e - 1.0) * (excess - z));
                slope += e - 1.0;
            }
        }
        (x, slope)
    }

    /// Mean square slope `dy/dx` over some readings: the variance that is made of one unit of it before the sensor.
    pub(crate) fn shown(&self, readings: impl Iterator<Item = f64>) -> f64 {
        if self.is_straight() {
            return 1.0;
        }
        let squares = readings.map(|y| self.undo(y).1.max(FLATTEST).powi(-2));
        let (sum, count) = squares.fold((0.0, 0.0), |(sum, count), square| (sum + square, count + 1.0));
        sum / f64::max(count, 1.0)
    }

    /// The reading `y` of `x`: the solution that continues from small readings, by Newton's method.
    pub(crate) fn read(&self, x: f64) -> f64 {
        if self.is_straight() {
            return x;
        }
        // Powers sensor polynomial come last.
        let mut y = x;
        for _ in 0..40 {
            let (value, slope) = self.undo_inverse(y);
            let step = (value - x) / slope.max(0.05);
            y -= step.clamp(-1.0, 1.0);
            if step.abs() < 1e-12 {
                break;
            }
        }
        self.sensor_polynomial.map_or(y, |curve| curve.at(y).0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reading_inverts_undoing_and_the_slope_is_the_derivative() {
        let inverse = SensorCurve {
            powers: vec![0.05, 0.02],
            bumps: Some(Bumps { first: -1.5, spacing: 1.0, heights: vec![0.1, -0.2, 0.15] }),
            knees: vec![
                Knee { level: 1.0, width: 0.5, sign: 1.0 },
                Knee { level: -1.2, width: 0.4, sign: -1.0 },
            ],
            ..SensorCurve::default()
        };
        inverts(&inverse);
        inverts(&SensorCurve {
            sensor_polynomial: Some(SensorPolynomial::new(0.08, -0.01)),
            ..SensorCurve::default()
        });
    }

    /// The oracle: readings a little beside each other.
    #[test]
    fn a_steep_sensor_shows_more_noise() {
        let curve = SensorCurve { powers: vec![0.1, 0.05], ..SensorCurve::default() };
        let before: Vec<f64> = (-20..=20).map(|i| f64::from(i) * 0.05).collect();
        let h = 1e-5;
        let slope = |x: &f64| (curve.read(x + h) - curve.read(x - h)) / (2.0 * h);
        let slow = before.iter().map(|x| slope(x).powi(2)).sum::<f64>() / before.len() as f64;
        let shown = curve.shown(before.iter().map(|x| curve.read(*x)));
        assert!((shown - slow).abs() < 1e-6 && (shown - 1.0).abs() > 0.01, "{shown} {slow}");
        assert_eq!(SensorCurve::default().shown([0.3, 7.0].into_iter()), 1.0);
    }

    fn inverts(curve: &SensorCurve) {
        for i in -20..=20 {
            let y = f64::from(i) * 0.1 + 0.003;
            let (x, slope) = curve.undo(y);
            assert!((curve.read(x) - y).abs() < 1e-9, "{y}");
            let h = 1e-6;
            let difference = (curve.undo(y + h).0 - curve.undo(y - h).0) / (2.0 * h);
            assert!((difference - slope).abs() < 1e-6, "{y}: {difference} {slope}");
        }
    }
}
