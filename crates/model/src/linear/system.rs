//! The linear part of a Hammerstein system.

use super::polynomial::{is_stable, relative_coprimeness, settling_samples};
use thiserror::Error;

/// `A(q⁻¹) y(t) = B(q⁻¹) u(t) + ξ(t)` with `A = 1 + a₁q⁻¹ + … + aₙq⁻ⁿ`, `B = b₁q⁻¹ + … + bₙq⁻ⁿ`.
///
/// Holds what the paper assumes of it: `A` stable, `A` and `B` coprime, `B(1) ≠ 0`, order `n ≥ 1`.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearSystem {
    a: Vec<f64>,
    b: Vec<f64>,
}

/// Below this the Sylvester matrix is singular to working precision for all a data set could show.
const COPRIME_TOLERANCE: f64 = 1e-10;

/// Why two coefficient lists are no identifiable system.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SystemError {
    /// The lists are empty or of different lengths.
    #[error("a has {a} coefficients and b {b}; both need n of them, n at least 1")]
    Order {
        /// Length of `a`.
        a: usize,
        /// Length of `b`.
        b: usize,
    },
    /// A coefficient is NaN or infinite.
    #[error("{name} is {value}; every coefficient must be finite")]
    NotFinite {
        /// `a1`, `b2`, …
        name: String,
        /// The offending value.
        value: f64,
    },
    /// A pole lies on or outside the unit circle.
    #[error(
        "A is unstable: its slowest pole has modulus {radius:.6}; every pole must lie inside the unit circle"
    )]
    Unstable {
        /// Largest modulus among the poles.
        radius: f64,
    },
    /// `B(1) = 0`.
    #[error(
        "B(1) = {0}: the static gain vanishes, so no experiment can find the level of the borders; change b"
    )]
    NoStaticGain(f64),
    /// `A` and `B` share a root.
    #[error(
        "A and B share a root (relative singular value {0:e}), so the order is lower than stated; cancel it"
    )]
    NotCoprime(f64),
}

impl LinearSystem {
    /// Checks and joins `a₁…aₙ` and `b₁…bₙ`.
    ///
    /// # Errors
    /// [`SystemError`] if an assumption of the paper fails.
    pub fn new(a: Vec<f64>, b: Vec<f64>) -> Result<Self, SystemError> {
        if a.is_empty() || a.len() != b.len() {
            return Err(SystemError::Order { a: a.len(), b: b.len() });
        }
        for (letter, values) in [("a", &a), ("b", &b)] {
            if let Some((i, &value)) = values.iter().enumerate().find(|(_, x)| !x.is_finite()) {
                return Err(SystemError::NotFinite { name: format!("{letter}{}", i + 1), value });
            }
        }
        if !is_stable(&a) {
            return Err(SystemError::Unstable { radius: super::spectral_radius(&a) });
        }
        let sum: f64 = b.iter().sum();
        if sum.abs() <= 1e-12 * b.iter().map(|x| x.abs()).sum::<f64>() {
            return Err(SystemError::NoStaticGain(sum));
        }
        let coprime = relative_coprimeness(&a, &b);
        if coprime < COPRIME_TOLERANCE {
            return Err(SystemError::NotCoprime(coprime));
        }
        Ok(Self { a, b })
    }

    /// The order `n`.
    pub fn order(&self) -> usize {
        self.a.len()
    }

    /// `a₁…aₙ`.
    pub fn a(&self) -> &[f64] {
        &self.a
    }

    /// `b₁…bₙ`.
    pub fn b(&self) -> &[f64] {
        &self.b
    }

    /// `A(1)`, positive for a stable system.
    pub(crate) fn a_at_one(&self) -> f64 {
        1.0 + self.a.iter().sum::<f64>()
    }

    /// `B(1)`, never zero.
    pub(crate) fn b_at_one(&self) -> f64 {
        self.b.iter().sum()
    }

    /// The static gain `B(1)/A(1)`: output units per unit of `u`.
    pub fn static_gain(&self) -> f64 {
        self.b_at_one() / self.a_at_one()
    }

    /// The same system for an input scaled by `1/k`: `(A, kB)`. With `k = u_M − u_m` this is the paper's normalisation.
    ///
    /// # Panics
    /// If `k` is zero or not finite.
    pub fn normalised(&self, k: f64) -> Self {
        assert!(k.is_finite() && k != 0.0, "the normalisation divides by k");
        Self { a: self.a.clone(), b: self.b.iter().map(|x| x * k).collect() }
    }

    /// Samples until a transient has fallen to `tolerance` of its start.
    pub fn settling_samples(&self, tolerance: f64) -> usize {
        settling_samples(&self.a, tolerance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_paper_assumes_is_checked() {
        assert!(LinearSystem::new(vec![-1.2, 0.5], vec![0.3, 0.2]).is_ok());
        assert!(matches!(
            LinearSystem::new(vec![-1.2, 0.5], vec![0.3]),
            Err(SystemError::Order { a: 2, b: 1 })
        ));
        assert!(matches!(
            LinearSystem::new(vec![-2.1, 1.1], vec![0.3, 0.2]),
            Err(SystemError::Unstable { .. })
        ));
        assert!(matches!(
            LinearSystem::new(vec![-1.2, 0.5], vec![0.3, -0.3]),
            Err(SystemError::NoStaticGain(_))
        ));
        // (q − 0.5)(q − 0.7) with a zero at 0.7
        assert!(matches!(
            LinearSystem::new(vec![-1.2, 0.35], vec![1.0, -0.7]),
            Err(SystemError::NotCoprime(_))
        ));
        assert!(matches!(
            LinearSystem::new(vec![f64::NAN, 0.5], vec![0.3, 0.2]),
            Err(SystemError::NotFinite { .. })
        ));
    }

    #[test]
    fn normalising_keeps_the_static_output() {
        let system = LinearSystem::new(vec![-0.5], vec![2.0]).expect("a valid system");
        assert_eq!(system.normalised(4.0).static_gain() * 0.25, system.static_gain());
    }
}
