//! The working interval.

use thiserror::Error;

/// The working interval `[h_m, h_M]` of the input, `h_m < h_M`, in input units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    low: f64,
    high: f64,
}

/// Why two numbers are no working interval.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error(
    "[{low}, {high}] is not an interval: both ends and their distance must be finite and the first below the second"
)]
pub struct IntervalError {
    /// The first end given.
    pub low: f64,
    /// The second end given.
    pub high: f64,
}

impl Interval {
    /// The interval from `low` (`h_m`) to `high` (`h_M`).
    ///
    /// # Errors
    /// [`IntervalError`] unless both and their distance are finite and `low < high`.
    pub fn new(low: f64, high: f64) -> Result<Self, IntervalError> {
        if low.is_finite() && high.is_finite() && (high - low).is_finite() && low < high {
            Ok(Self { low, high })
        } else {
            Err(IntervalError { low, high })
        }
    }

    /// The lower end `h_m`.
    pub fn low(&self) -> f64 {
        self.low
    }

    /// The upper end `h_M`.
    pub fn high(&self) -> f64 {
        self.high
    }

    /// `h_M − h_m`, positive.
    pub fn width(&self) -> f64 {
        self.high - self.low
    }

    /// Whether `v` lies in the closed interval.
    pub fn contains(&self, v: f64) -> bool {
        (self.low..=self.high).contains(&v)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_that_are_equal_swapped_or_not_finite_are_refused() {
        for (low, high) in
            [(1.0, 1.0), (2.0, 1.0), (f64::NAN, 1.0), (0.0, f64::INFINITY), (-1.7e308, 1.7e308)]
        {
            assert!(Interval::new(low, high).is_err());
        }
    }

    #[test]
    fn both_ends_belong_to_the_interval() {
        let interval = Interval::new(-1.0, 2.0).unwrap();
        assert!(interval.contains(-1.0) && interval.contains(2.0) && interval.contains(0.0));
        assert!(!interval.contains(2.1) && !interval.contains(f64::NAN));
        assert_eq!(interval.width(), 3.0);
    }
}
