//! The relay.

use super::border_error::finite;
use super::{BorderError, BorderPair};

/// A relay: two levels, switching at one threshold while `v` rises and at another while it falls.
///
/// ```text
/// C_a(v) = high if v ≥ ascending_threshold,  else low
/// C_d(v) = high if v > descending_threshold, else low
/// ```
///
/// Levels in `u` units, `low < high`; thresholds in input units, in either order. Assumption 1 then asks that
/// `ascending_threshold ≤ h_M` and `h_m ≤ descending_threshold`: the relay must switch inside the working interval.
///
/// It is the switched hysteresis with the relay's borders: the level follows the direction of `v` at every reversal.
///
/// Reference: F. Giri, Y. Rochdi, F.Z. Chaoui, A. Brouri, Automatica 44 (2008), hysteresis-relay.
///
/// ```
/// use switchback_model::hysteresis::{BorderPair, Relay};
/// let relay = Relay::new((-1.0, 2.0), 0.3, -0.3)?;
/// assert_eq!((relay.ascending(0.0), relay.ascending(0.3)), (-1.0, 2.0));
/// assert_eq!((relay.descending(0.0), relay.descending(-0.3)), (2.0, -1.0));
/// # Ok::<(), switchback_model::hysteresis::BorderError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Relay {
    low: f64,
    high: f64,
    ascending_threshold: f64,
    descending_threshold: f64,
}

impl Relay {
    /// A relay between `levels = (low, high)`.
    ///
    /// # Errors
    /// [`BorderError::NotFinite`], or [`BorderError::RelayLevels`] unless `low < high`.
    pub fn new(
        levels: (f64, f64),
        ascending_threshold: f64,
        descending_threshold: f64,
    ) -> Result<Self, BorderError> {
        let (low, high) = levels;
        finite("low", low)?;
        finite("high", high)?;
        finite("ascending_threshold", ascending_threshold)?;
        finite("descending_threshold", descending_threshold)?;
        if low >= high {
            return Err(BorderError::RelayLevels { low, high });
        }
        Ok(Self { low, high, ascending_threshold, descending_threshold })
    }
}

impl BorderPair for Relay {
    fn ascending(&self, v: f64) -> f64 {
        if v >= self.ascending_threshold { self.high } else { self.low }
    }

    fn descending(&self, v: f64) -> f64 {
        if v > self.descending_threshold { self.high } else { self.low }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hysteresis::{Interval, SwitchedHysteresis};

    #[test]
    fn levels_that_are_equal_or_swapped_are_refused() {
        for levels in [(1.0, 1.0), (2.0, -1.0)] {
            assert!(matches!(Relay::new(levels, 0.0, 0.0), Err(BorderError::RelayLevels { .. })));
        }
    }

    #[test]
    fn thresholds_may_lie_in_either_order() {
        let early = Relay::new((0.0, 1.0), -0.3, 0.3).unwrap();
        assert_eq!((early.ascending(0.0), early.descending(0.0)), (1.0, 0.0));
    }

    #[test]
    fn a_relay_that_does_not_switch_inside_the_interval_fails_assumption_1() {
        let interval = Interval::new(-1.0, 1.0).unwrap();
        let builds = |up, down| {
            SwitchedHysteresis::new(interval, Box::new(Relay::new((0.0, 1.0), up, down).unwrap())).is_ok()
        };
        assert!(builds(1.0, -1.0), "both ends of the interval count as inside");
        assert!(!builds(1.1, 0.0));
        assert!(!builds(0.0, -1.1));
    }

    #[test]
    fn a_threshold_that_is_not_finite_is_named() {
        let error = Relay::new((0.0, 1.0), 0.0, f64::NEG_INFINITY).unwrap_err();
        assert_eq!(error.to_string(), "descending_threshold = -inf: give a finite number");
    }
}
