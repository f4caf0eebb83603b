//! Two straight lines.

use super::border_error::all_finite;
use super::{BorderError, BorderPair, Branch};

/// A straight line `offset + slope·v`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// `u` units per input unit.
    pub slope: f64,
    /// Value at `v = 0`, `u` units.
    pub offset: f64,
}

impl Line {
    fn at(&self, v: f64) -> f64 {
        self.offset + self.slope * v
    }
}

/// Borders that are two straight lines.
///
/// ```text
/// C_a(v) = ascending.offset  + ascending.slope·v
/// C_d(v) = descending.offset + descending.slope·v
/// ```
///
/// Slopes in `u` units per input unit, offsets in `u` units. The lines need not be parallel and may cross.
///
/// Reference: F. Giri, Y. Rochdi, F.Z. Chaoui, A. Brouri, "Identification of Hammerstein systems in presence of
/// hysteresis-backlash and hysteresis-relay nonlinearities", Automatica 44 (2008), where the borders are lines.
///
/// ```
/// use switchback_model::hysteresis::{BorderPair, Line, StraightLines};
/// let borders = StraightLines::new(Line { slope: 1.0, offset: 0.5 }, Line { slope: 2.0, offset: -0.5 })?;
/// assert_eq!((borders.ascending(1.0), borders.descending(1.0)), (1.5, 1.5));
/// # Ok::<(), switchback_model::hysteresis::BorderError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StraightLines {
    ascending: Line,
    descending: Line,
}

impl StraightLines {
    /// Joins the two lines.
    ///
    /// # Errors
    /// [`BorderError::NotFinite`].
    pub fn new(ascending: Line, descending: Line) -> Result<Self, BorderError> {
        for (branch, line) in [(Branch::Ascending, &ascending), (Branch::Descending, &descending)] {
            all_finite(branch, &[("slope", line.slope), ("offset", line.offset)])?;
        }
        Ok(Self { ascending, descending })
    }
}

impl BorderPair for StraightLines {
    fn ascending(&self, v: f64) -> f64 {
        self.ascending.at(v)
    }

    fn descending(&self, v: f64) -> f64 {
        self.descending.at(v)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parameter_that_is_not_finite_is_named_with_its_border() {
        let line = Line { slope: 1.0, offset: 0.0 };
        let error = StraightLines::new(line, Line { slope: f64::NAN, ..line }).unwrap_err();
        assert_eq!(error.to_string(), "descending.slope = NaN: give a finite number");
        let error = StraightLines::new(Line { offset: f64::INFINITY, ..line }, line).unwrap_err();
        assert_eq!(error.to_string(), "ascending.offset = inf: give a finite number");
    }
}
