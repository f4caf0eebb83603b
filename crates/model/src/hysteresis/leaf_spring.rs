//! The leaf spring: an elastic force with dry friction between its leaves.

use super::border_error::finite;
use super::{BorderError, BorderPair};

/// A leaf spring: stiffness times deflection, plus or minus the Coulomb friction of its leaves.
///
/// ```text
/// C_a(x) = k(x)·x + F_C
/// C_d(x) = k(x)·x − F_C
/// k(x)   = k0 + k2·x²
/// ```
///
/// Deflection `x` in input units (mm), `k0` (`stiffness`) in `u` units per input unit (kN/mm), `k2` (`hardening`) in
/// `u` units per cubed input unit (kN/mm³; zero for constant stiffness, negative for a softening spring), `F_C`
/// (`friction`) in `u` units (kN), not negative.
///
/// Reference: P.S. Fancher et al., "Measurement and representation of the mechanical properties of truck leaf
/// springs", SAE 800905 (1980), whose loading and unloading envelopes are the two borders.
///
/// ```
/// use switchback_model::hysteresis::{BorderPair, LeafSpring};
/// let spring = LeafSpring::hardening(0.2, 0.001, 0.8)?;
/// assert!((spring.ascending(10.0) - (2.0 + 1.0 + 0.8)).abs() < 1e-12);
/// assert!((spring.descending(10.0) - (2.0 + 1.0 - 0.8)).abs() < 1e-12);
/// assert!(LeafSpring::constant(0.2, -0.8).is_err());
/// # Ok::<(), switchback_model::hysteresis::BorderError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeafSpring {
    stiffness: f64,
    hardening: f64,
    friction: f64,
}

impl LeafSpring {
    /// A spring of constant stiffness, `k2 = 0`.
    ///
    /// # Errors
    /// As [`hardening`](Self::hardening).
    pub fn constant(stiffness: f64, friction: f64) -> Result<Self, BorderError> {
        Self::hardening(stiffness, 0.0, friction)
    }

    /// A spring of stiffness `k0 + k2·x²`.
    ///
    /// # Errors
    /// [`BorderError::NotFinite`], or [`BorderError::Negative`] for the friction.
    pub fn hardening(stiffness: f64, hardening: f64, friction: f64) -> Result<Self, BorderError> {
        for (name, value) in [("stiffness", stiffness), ("hardening", hardening), ("friction", friction)] {
            finite(name, value)?;
        }
        if friction < 0.0 {
            return Err(BorderError::Negative { parameter: "friction".to_owned(), value: friction });
        }
        Ok(Self { stiffness, hardening, friction })
    }

    fn elastic(&self, x: f64) -> f64 {
        (self.stiffness + self.hardening * x * x) * x
    }
}

impl BorderPair for LeafSpring {
    fn ascending(&self, v: f64) -> f64 {
        self.elastic(v) + self.friction
    }

    fn descending(&self, v: f64) -> f64 {
        self.elastic(v) - self.friction
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_borders_lie_twice_the_friction_apart_everywhere() {
        let spring = LeafSpring::hardening(0.5, 0.25, 1.5).unwrap();
        for x in [-4.0, -1.0, 0.0, 2.0, 8.0] {
            assert_eq!(spring.ascending(x) - spring.descending(x), 3.0);
        }
    }

    #[test]
    fn hardening_adds_a_cube_and_constant_stiffness_none() {
        let (hard, plain) =
            (LeafSpring::hardening(0.5, 0.25, 1.5).unwrap(), LeafSpring::constant(0.5, 1.5).unwrap());
        for x in [-2.0, 0.0, 4.0] {
            assert_eq!(hard.ascending(x) - plain.ascending(x), 0.25 * x * x * x);
        }
    }

    #[test]
    fn negative_friction_is_refused() {
        let error = LeafSpring::constant(1.0, -0.5).unwrap_err();
        assert_eq!(error.to_string(), "friction = -0.5: give a number that is not negative");
    }

    #[test]
    fn parameters_that_are_not_finite_are_refused() {
        for (k0, k2, fc) in [(f64::NAN, 0.0, 0.0), (0.0, f64::INFINITY, 0.0), (0.0, 0.0, f64::NAN)] {
            assert!(matches!(LeafSpring::hardening(k0, k2, fc), Err(BorderError::NotFinite { .. })));
        }
    }
}
