//! The operator `u = F[v]`.

use super::{BorderPair, Branch, Interval};
use std::sync::Arc;
use thiserror::Error;

/// The switched hysteresis (2.3) on a working interval.
///
/// ```text
/// u(t) = C_a(v(t))  when v(t) > v(t−1)
///        C_d(v(t))  when v(t) < v(t−1)
///        u(t−1)     when v(t) = v(t−1)
/// ```
///
/// Assumption 1 holds: `u_m = C_d(h_m) < u_M = C_a(h_M)`, both finite. The borders may be discontinuous and need
/// not be invertible. Clones share their borders.
#[derive(Debug, Clone)]
pub struct SwitchedHysteresis {
    interval: Interval,
    borders: Arc<dyn BorderPair>,
}

/// Why a pair of borders is no switched hysteresis on the interval.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum HysteresisError {
    /// Assumption 1 is violated.
    #[error(
        "Assumption 1 fails: C_d(h_m) = {u_low} must lie below C_a(h_M) = {u_high}; change the borders or the interval"
    )]
    Assumption1 {
        /// `C_d(h_m)`.
        u_low: f64,
        /// `C_a(h_M)`.
        u_high: f64,
    },
}

impl SwitchedHysteresis {
    /// Joins borders and interval, checking Assumption 1.
    ///
    /// # Errors
    /// [`HysteresisError::Assumption1`] unless `C_d(h_m) < C_a(h_M)` and both are finite.
    pub fn new(interval: Interval, borders: Box<dyn BorderPair>) -> Result<Self, HysteresisError> {
        let u_low = borders.descending(interval.low());
        let u_high = borders.ascending(interval.high());
        if u_low.is_finite() && u_high.is_finite() && u_low < u_high {
            Ok(Self { interval, borders: borders.into() })
        } else {
            Err(HysteresisError::Assumption1 { u_low, u_high })
        }
    }

    /// The working interval.
    pub fn interval(&self) -> Interval {
        self.interval
    }

    /// The border of the given branch at `v`.
    pub fn border(&self, branch: Branch, v: f64) -> f64 {
        match branch {
            Branch::Ascending => self.borders.ascending(v),
            Branch::Descending => self.borders.descending(v),
        }
    }

    /// `u_m = C_d(h_m)`.
    pub fn u_low(&self) -> f64 {
        self.border(Branch::Descending, self.interval.low())
    }

    /// `u_M = C_a(h_M)`.
    pub fn u_high(&self) -> f64 {
        self.border(Branch::Ascending, self.interval.high())
    }

    /// `u_M − u_m`, the factor `k` that the paper's normalisation divides out; positive.
    pub fn span(&self) -> f64 {
        self.u_high() - self.u_low()
    }

    /// `u = F[v]` for a whole input, given `u` before its first sample.
    ///
    /// The first sample has no predecessor, so `u` keeps `before` until `v` first moves.
    pub fn output(&self, v: &[f64], before: f64) -> Vec<f64> {
        let mut u = before;
        let mut previous = v.first().copied();
        v.iter()
            .map(|&now| {
                match previous.and_then(|p| now.partial_cmp(&p)) {
                    Some(std::cmp::Ordering::Greater) => u = self.border(Branch::Ascending, now),
                    Some(std::cmp::Ordering::Less) => u = self.border(Branch::Descending, now),
                    _ => {}
                }
                previous = Some(now);
                u
            })
            .collect()
    }
}
