//! A figure and its Monte-Carlo standard error.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A performance measure with its Monte-Carlo standard error (MCSE), both finite; serialised as `[value, mcse]`.
///
/// Stored to a ten-thousandth of its error: further digits are noise of the simulation, and files stay small.
///
/// ```
/// # use switchback_study::results::Measured;
/// let bias = Measured::new(0.123_456_789, 0.01).expect("finite");
/// assert_eq!((bias.value(), bias.mcse()), (0.123_457, 0.01));
/// assert!(Measured::new(f64::NAN, 0.1).is_none());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "(f64, f64)", into = "(f64, f64)")]
#[schemars(extend("prefixItems" = [{ "type": "number" }, { "type": "number", "minimum": 0 }]))]
pub struct Measured {
    value: f64,
    mcse: f64,
}

/// Why a pair of numbers is no measured figure.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("[{0}, {1}] is not a figure with its error: both must be finite and the error not negative")]
pub struct MeasuredError(f64, f64);

/// Figures are kept to this share of their Monte-Carlo standard error.
const RESOLUTION: f64 = 1e-4;

impl Measured {
    /// A figure and its error; `None` unless both are finite and the error is not negative.
    pub fn new(value: f64, mcse: f64) -> Option<Self> {
        let valid = value.is_finite() && mcse.is_finite() && mcse >= 0.0;
        valid.then(|| Self {
            value: rounded(value, mcse * RESOLUTION),
            mcse: rounded(mcse, mcse * RESOLUTION),
        })
    }

    /// The figure with so many significant digits at most and no more than a tenth of its error asks for, the error with two.
    pub(super) fn shortened(self, digits: u32) -> Self {
        let value = rounded(significant(self.value, digits), 0.1 * self.mcse);
        Self { value, mcse: significant(self.mcse, 2) }
    }

    /// The figure.
    pub fn value(&self) -> f64 {
        self.value
    }

    /// Its Monte-Carlo standard error, not negative; zero for a figure known exactly.
    pub fn mcse(&self) -> f64 {
        self.mcse
    }

    /// How many of its errors the figure lies from `target`; zero where both agree exactly, `None` where the error is zero.
    pub fn z(&self, target: f64) -> Option<f64> {
        let difference = self.value - target;
        match (difference == 0.0, self.mcse == 0.0) {
            (true, _) => Some(0.0),
            (false, true) => None,
            (false, false) => Some(difference / self.mcse),
        }
    }
}

impl TryFrom<(f64, f64)> for Measured {
    type Error = MeasuredError;

    fn try_from((value, mcse): (f64, f64)) -> Result<Self, MeasuredError> {
        Self::new(value, mcse).ok_or(MeasuredError(value, mcse))
    }
}

impl From<Measured> for (f64, f64) {
    fn from(m: Measured) -> Self {
        (m.value, m.mcse)
    }
}

/// The number rounded to so many significant digits.
pub(super) fn significant(x: f64, digits: u32) -> f64 {
    format!("{x:.*e}", digits.saturating_sub(1) as usize).parse().unwrap_or(x)
}

/// The decimal number with fewest digits within `resolution` of `x`; `x` itself where the resolution is zero.
pub(super) fn rounded(x: f64, resolution: f64) -> f64 {
    if resolution <= 0.0 || x == 0.0 {
        return x;
    }
    let digits = x.abs().log10().floor() - resolution.log10().floor();
    if digits < 0.0 {
        return 0.0;
    }
    if digits > 15.0 {
        return x;
    }
    format!("{x:.*e}", digits as usize).parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn rounding_stays_within_a_ten_thousandth_of_the_error_and_repeats_itself(
            value in -1e6..1e6f64,
            exponent in -12..4i32,
        ) {
            let mcse = 1.234_567_89 * 10f64.powi(exponent);
            let once = Measured::new(value, mcse).expect("finite");
            prop_assert!((once.value() - value).abs() <= RESOLUTION * mcse);
            prop_assert_eq!(Measured::new(once.value(), once.mcse()), Some(once));
        }

        #[test]
        fn a_figure_survives_json_to_the_last_bit(value in any::<f64>(), mcse in 0.0..1e300f64) {
            if let Some(figure) = Measured::new(value, mcse) {
                let json = serde_json::to_string(&figure).expect("finite numbers serialise");
                prop_assert_eq!(serde_json::from_str::<Measured>(&json).expect("it reads back"), figure);
            }
        }
    }

    #[test]
    fn what_is_not_finite_is_no_figure() {
        assert!(Measured::new(1.0, f64::INFINITY).is_none());
        assert!(Measured::new(1.0, -0.1).is_none());
        assert!(serde_json::from_str::<Measured>("[1.0, -1.0]").is_err());
    }

    #[test]
    fn the_distance_is_counted_in_errors() {
        let figure = Measured::new(1.5, 0.25).expect("finite");
        assert_eq!(figure.z(1.0), Some(2.0));
        let exact = Measured::new(1.5, 0.0).expect("finite");
        assert_eq!((exact.z(1.5), exact.z(1.0)), (Some(0.0), None));
    }
}
