//! Borders that rise and fall.

use super::border_error::all_finite;
use super::{BorderError, BorderPair, Branch};
use std::f64::consts::TAU;

/// A line with a sine on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wave {
    /// Value of the line at `v = 0`, `u` units.
    pub offset: f64,
    /// Slope of the line, `u` units per input unit.
    pub slope: f64,
    /// Amplitude of the sine, `u` units.
    pub amplitude: f64,
    /// Length of a whole wave, input units, positive.
    pub wavelength: f64,
    /// Phase of the sine at `v = 0`, radians.
    pub phase: f64,
}

impl Wave {
    fn at(&self, v: f64) -> f64 {
        self.offset + self.slope * v + self.amplitude * (TAU * v / self.wavelength + self.phase).sin()
    }

    fn steepest(&self) -> f64 {
        TAU * self.amplitude.abs() / self.wavelength
    }

    fn turns(&self) -> bool {
        self.steepest() > self.slope.abs()
    }
}

/// Borders that rise and fall, and so have no inverse.
///
/// ```text
/// C(v) = offset + slope·v + amplitude·sin(2π·v/wavelength + phase)
/// ```
///
/// Offset and amplitude in `u` units, slope in `u` units per input unit, wavelength in input units, phase in radians.
/// At least one border must turn: `2π·|amplitude|/wavelength > |slope|`.
///
/// Reference: the SYSID 2009 paper, which asks for no inverse of the borders.
///
/// ```
/// use switchback_model::hysteresis::{BorderPair, NonMonotone, Wave};
/// let wave = Wave { offset: 0.2, slope: 0.5, amplitude: 0.4, wavelength: 1.0, phase: 0.0 };
/// let borders = NonMonotone::new(wave, Wave { offset: -0.2, ..wave })?;
/// assert!(borders.ascending(0.25) > borders.ascending(0.75));
/// assert!(NonMonotone::new(Wave { amplitude: 0.0, ..wave }, Wave { amplitude: 0.01, ..wave }).is_err());
/// # Ok::<(), switchback_model::hysteresis::BorderError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NonMonotone {
    ascending: Wave,
    descending: Wave,
}

impl NonMonotone {
    /// Joins the two borders.
    ///
    /// # Errors
    /// [`BorderError::NotFinite`], [`BorderError::NotPositive`] for a wavelength, or [`BorderError::Monotone`] if
    /// neither border turns.
    pub fn new(ascending: Wave, descending: Wave) -> Result<Self, BorderError> {
        for (branch, wave) in [(Branch::Ascending, &ascending), (Branch::Descending, &descending)] {
            check(branch, wave)?;
        }
        if !ascending.turns() && !descending.turns() {
            return Err(BorderError::Monotone {
                ascending: ascending.steepest(),
                ascending_slope: ascending.slope,
                descending: descending.steepest(),
                descending_slope: descending.slope,
            });
        }
        Ok(Self { ascending, descending })
    }
}

fn check(branch: Branch, wave: &Wave) -> Result<(), BorderError> {
    let Wave { offset, slope, amplitude, wavelength, phase } = *wave;
    all_finite(
        branch,
        &[
            ("offset", offset),
            ("slope", slope),
            ("amplitude", amplitude),
            ("wavelength", wavelength),
            ("phase", phase),
        ],
    )?;
    if wavelength <= 0.0 {
        return Err(BorderError::NotPositive {
            parameter: format!("{branch}.wavelength"),
            value: wavelength,
        });
    }
    Ok(())
}

impl BorderPair for NonMonotone {
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

    const WAVE: Wave = Wave { offset: 0.0, slope: 1.0, amplitude: 1.0, wavelength: 2.0, phase: 0.5 };

    #[test]
    fn one_border_that_turns_is_enough() {
        let still = Wave { amplitude: 0.0, ..WAVE };
        assert!(NonMonotone::new(WAVE, still).is_ok());
        assert!(NonMonotone::new(still, WAVE).is_ok());
        assert!(matches!(NonMonotone::new(still, still), Err(BorderError::Monotone { .. })));
    }

    #[test]
    fn whole_waves_apart_only_the_line_differs() {
        let borders = NonMonotone::new(WAVE, WAVE).unwrap();
        assert!((borders.ascending(3.3) - borders.ascending(1.3) - 2.0).abs() < 1e-12);
    }

    #[test]
    fn a_wavelength_of_zero_is_refused() {
        let error = NonMonotone::new(WAVE, Wave { wavelength: 0.0, ..WAVE }).unwrap_err();
        assert_eq!(error.to_string(), "descending.wavelength = 0: give a number above zero");
    }
}
