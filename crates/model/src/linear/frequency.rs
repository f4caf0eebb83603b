//! What a linear system does to a sinusoid, and where its poles and zeros lie.

use nalgebra::{Complex, DMatrix};

/// Frequency response `H(e^{jω}) = Σᵢ bᵢ e^{−jω(delay+i)} / (1 + Σᵢ aᵢ e^{−jωi})`, i from 1.
///
/// `omega` is in radians a sample, from 0 to π; `delay` may be negative, where the output leads.
///
/// ```
/// # use switchback_model::linear::frequency_response;
/// // At rest the gain is B(1)/A(1) = 0.5/(1 − 0.5).
/// assert!((frequency_response(&[-0.5], &[0.5], 0, 0.0).re - 1.0).abs() < 1e-15);
/// ```
pub fn frequency_response(a: &[f64], b: &[f64], delay: isize, omega: f64) -> Complex<f64> {
    let turned = |by: f64| Complex::from_polar(1.0, -omega * by);
    let sum = |of: &[f64]| -> Complex<f64> {
        of.iter().enumerate().map(|(i, x)| turned((i + 1) as f64) * *x).sum()
    };
    turned(delay as f64) * sum(b) / (sum(a) + 1.0)
}

/// Roots of `c₀ zⁿ + c₁ zⁿ⁻¹ + … + cₙ`: eigenvalues of the companion matrix; with `c = [1, a₁, …, aₙ]` the poles of `1/A(q⁻¹)`.
///
/// Leading coefficients that are zero are left out; there is no root where no other is left. Sorted by real, then by imaginary part.
///
/// ```
/// # use switchback_model::linear::roots;
/// let found = roots(&[1.0, -0.8, 0.15]);
/// assert!((found[0].re - 0.3).abs() < 1e-12 && (found[1].re - 0.5).abs() < 1e-12);
/// ```
pub fn roots(coefficients: &[f64]) -> Vec<Complex<f64>> {
    let start = coefficients.iter().position(|c| *c != 0.0).unwrap_or(coefficients.len());
    let [lead, rest @ ..] = &coefficients[start..] else { return Vec::new() };
    let n = rest.len();
    if n == 0 || rest.iter().any(|c| !(c / lead).is_finite()) {
        return Vec::new();
    }
    let companion = DMatrix::from_fn(n, n, |i, j| match i {
        0 => -rest[j] / lead,
        _ => f64::from(u8::from(i == j + 1)),
    });
    let mut found: Vec<Complex<f64>> = companion.complex_eigenvalues().iter().copied().collect();
    found.sort_by(|x, y| x.re.total_cmp(&y.re).then(x.im.total_cmp(&y.im)));
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::filter;
    use proptest::prelude::*;

    proptest! {
        /// Oracle: the response of the difference equation to a sinusoid, once it has settled.
        #[test]
        fn a_sinusoid_comes_out_as_the_response_says(p in -0.8..0.8_f64, q in -0.8..0.8_f64, b1 in -1.0..1.0_f64, b2 in -1.0..1.0_f64, omega in 0.05..3.0_f64) {
            let (a, b) = ([-(p + q), p * q], [b1, b2]);
            let u: Vec<f64> = (0..400).map(|t| (omega * f64::from(t)).cos()).collect();
            let y = filter(&a, &b, &u, &[], 0.0, 0.0);
            let h = frequency_response(&a, &b, 0, omega);
            for t in 350..400 {
                let expected = (h * Complex::from_polar(1.0, omega * t as f64)).re;
                prop_assert!((y[t] - expected).abs() < 1e-9, "{} is not {expected}", y[t]);
            }
        }

        #[test]
        fn roots_are_those_the_polynomial_was_made_of(re in -0.9..0.9_f64, im in 0.1..0.9_f64, real in -0.9..0.9_f64) {
            // (z − real)(z² − 2·re·z + re² + im²)
            let (s, m) = (-2.0 * re, re * re + im * im);
            let found = roots(&[2.0, 2.0 * (s - real), 2.0 * (m - real * s), -2.0 * real * m]);
            for root in [Complex::new(re, im), Complex::new(re, -im), Complex::new(real, 0.0)] {
                let nearest = found.iter().map(|f| (f - root).norm()).fold(f64::INFINITY, f64::min);
                prop_assert!(nearest < 1e-6, "{root} is not among {found:?}");
            }
        }
    }

    #[test]
    fn a_delay_turns_and_a_zero_leading_coefficient_is_no_root() {
        let h = frequency_response(&[], &[1.0], 2, 0.5);
        assert!((h - Complex::from_polar(1.0, -1.5)).norm() < 1e-15);
        assert_eq!(roots(&[0.0, 0.0, 3.0]), []);
        assert_eq!(roots(&[]), []);
        assert_eq!(roots(&[0.0, 2.0, -1.0]), [Complex::new(0.5, 0.0)]);
    }
}
