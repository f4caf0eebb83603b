//! A sensor's characteristic in powers of what it senses.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `y = z + γ₂z² + γ₃z³`, dimensionless; where it gets too flat it goes on straight: one that folds back is no
/// sensor.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(from = "[f64; 2]", into = "[f64; 2]")]
pub(crate) struct SensorPolynomial {
    square: f64,
    cube: f64,
    /// Where it begins and ceases to be a polynomial.
    range: [f64; 2],
}

/// The coefficients show the range.
impl From<[f64; 2]> for SensorPolynomial {
    fn from([square, cube]: [f64; 2]) -> Self {
        Self::new(square, cube)
    }
}

impl From<SensorPolynomial> for [f64; 2] {
    fn from(curve: SensorPolynomial) -> Self {
        [curve.square, curve.cube]
    }
}

/// Least slope.
pub(crate) const FLATTEST: f64 = 0.05;
/// Newton steps at most.
const STEPS: usize = 60;

impl SensorPolynomial {
    pub(crate) fn new(square: f64, cube: f64) -> Self {
        let mut range = [f64::NEG_INFINITY, f64::INFINITY];
        // Roots of 3γ₃z² + 2γ₂z + 1 − FLATTEST, without cancellation; the slope at rest is one.
        let rest = 1.0 - FLATTEST;
        let discriminant = square * square - 3.0 * cube * rest;
        if discriminant >= 0.0 {
            let sum = -(square + discriminant.sqrt().copysign(square));
            for root in [sum / (3.0 * cube), rest / sum] {
                if root > 0.0 && root < range[1] {
                    range[1] = root;
                }
                if root < 0.0 && root > range[0] {
                    range[0] = root;
                }
            }
        }
        Self { square, cube, range }
    }

    /// The coefficients of `z²` and `z³`, and the range in which it is a polynomial.
    pub(crate) fn reported(&self) -> ([f64; 2], [f64; 2]) {
        ([self.square, self.cube], self.range)
    }

    /// The reading of `z`, and its slope.
    pub(crate) fn at(&self, z: f64) -> (f64, f64) {
        let x = z.clamp(self.range[0], self.range[1]);
        let value = x + x * x * (self.square + self.cube * x);
        let slope = (1.0 + x * (2.0 * self.square + 3.0 * self.cube * x)).max(FLATTEST);
        (value + slope * (z - x), slope)
    }

    /// `z` at a reading `y`, and `dz/dy`.
    pub(crate) fn undo(&self, y: f64) -> (f64, f64) {
        let mut z = y;
        for _ in 0..STEPS {
            let (value, slope) = self.at(z);
            let step = ((value - y) / slope).clamp(-2.0, 2.0);
            z -= step;
            if step.abs() < 1e-13 * (1.0 + z.abs()) {
                break;
            }
        }
        (z, 1.0 / self.at(z).1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_square_is_undone_by_its_root() {
        let (z, slope) = SensorPolynomial::new(0.2, 0.0).undo(1.4);
        assert!((z + 0.2 * z * z - 1.4).abs() < 1e-12 && (slope * (1.0 + 0.4 * z) - 1.0).abs() < 1e-12);
        assert_eq!(SensorPolynomial::new(0.0, 0.0).undo(-1.3), (-1.3, 1.0));
    }

    proptest! {
        #[test]
        fn it_rises_everywhere_and_undoing_inverts_it(
            square in -0.4..0.4_f64, cube in -0.4..0.4_f64, z in -4.0..4.0_f64,
        ) {
            let curve = SensorPolynomial::new(square, cube);
            let (y, slope) = curve.at(z);
            prop_assert!(slope >= FLATTEST && curve.at(z + 1e-3).0 > y);
            prop_assert!((curve.undo(y).0 - z).abs() < 1e-8, "{} {z}", curve.undo(y).0);
        }
    }
}
