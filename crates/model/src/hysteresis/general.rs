//! The general smooth shape.

use super::border_error::all_finite;
use super::{BorderError, BorderPair, Branch};

/// A saturating S-curve on a curved base line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SaturatingCurve {
    /// Value at the centre, `u` units.
    pub offset: f64,
    /// Half the height of the S, `u` units.
    pub amplitude: f64,
    /// Where the S is steepest, input units.
    pub centre: f64,
    /// Half the width of the S, input units, positive.
    pub width: f64,
    /// Slope of the base line at the centre, `u` units per input unit.
    pub slope: f64,
    /// Curvature of the base line, `u` units per squared input unit.
    pub curvature: f64,
}

impl SaturatingCurve {
    fn at(&self, v: f64) -> f64 {
        let x = v - self.centre;
        self.offset + self.amplitude * (x / self.width).tanh() + (self.slope + self.curvature * x) * x
    }
}

/// Smooth borders of general shape: saturating, curved, and different from each other.
///
/// ```text
/// C(v) = offset + amplitude·tanh((v − centre)/width) + slope·(v − centre) + curvature·(v − centre)²
/// ```
///
/// Offset and amplitude in `u` units, centre and width in input units, slope and curvature in `u` units per input
/// unit and per squared input unit.
///
/// Reference: the general switched hysteresis of the SYSID 2009 paper, Fig. 3.
///
/// ```
/// use switchback_model::hysteresis::{BorderPair, General, SaturatingCurve};
/// let up = SaturatingCurve { offset: 0.0, amplitude: 1.0, centre: 0.3, width: 0.4, slope: 0.1, curvature: 0.0 };
/// let down = SaturatingCurve { centre: -0.3, width: 0.6, curvature: 0.1, ..up };
/// let borders = General::new(up, down)?;
/// assert_eq!((borders.ascending(0.3), borders.descending(-0.3)), (0.0, 0.0));
/// # Ok::<(), switchback_model::hysteresis::BorderError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct General {
    ascending: SaturatingCurve,
    descending: SaturatingCurve,
}

impl General {
    /// Joins the two curves.
    ///
    /// # Errors
    /// [`BorderError::NotFinite`], or [`BorderError::NotPositive`] for a width.
    pub fn new(ascending: SaturatingCurve, descending: SaturatingCurve) -> Result<Self, BorderError> {
        for (branch, curve) in [(Branch::Ascending, &ascending), (Branch::Descending, &descending)] {
            check(branch, curve)?;
        }
        Ok(Self { ascending, descending })
    }
}

fn check(branch: Branch, curve: &SaturatingCurve) -> Result<(), BorderError> {
    let SaturatingCurve { offset, amplitude, centre, width, slope, curvature } = *curve;
    all_finite(
        branch,
        &[
            ("offset", offset),
            ("amplitude", amplitude),
            ("centre", centre),
            ("width", width),
            ("slope", slope),
            ("curvature", curvature),
        ],
    )?;
    if width <= 0.0 {
        return Err(BorderError::NotPositive { parameter: format!("{branch}.width"), value: width });
    }
    Ok(())
}

impl BorderPair for General {
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

    const CURVE: SaturatingCurve =
        SaturatingCurve { offset: 0.5, amplitude: 2.0, centre: 1.0, width: 0.25, slope: 0.0, curvature: 0.0 };

    #[test]
    fn without_a_base_line_the_curve_saturates_at_its_amplitude() {
        let borders = General::new(CURVE, CURVE).unwrap();
        assert!((borders.ascending(20.0) - 2.5).abs() < 1e-12);
        assert!((borders.descending(-20.0) + 1.5).abs() < 1e-12);
    }

    #[test]
    fn without_an_s_the_curve_is_a_parabola_about_its_centre() {
        let parabola = SaturatingCurve { amplitude: 0.0, slope: 3.0, curvature: 0.5, ..CURVE };
        let borders = General::new(parabola, CURVE).unwrap();
        assert_eq!(borders.ascending(3.0), 0.5 + 3.0 * 2.0 + 0.5 * 4.0);
    }

    #[test]
    fn a_negative_width_is_refused() {
        let error = General::new(SaturatingCurve { width: -1.0, ..CURVE }, CURVE).unwrap_err();
        assert_eq!(error.to_string(), "ascending.width = -1: give a number above zero");
    }
}
