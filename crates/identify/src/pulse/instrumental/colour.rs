//! The spectrum of the noise from its autocovariances.

use nalgebra::Complex;

/// An autoregression of the noise, `D(q⁻¹) e(t) = w(t)`, through its first autocovariances.
///
/// ```text
/// S(ω) = v / |D(e^{jω})|²,   D = 1 + d₁q⁻¹ + … + d_Lq⁻ᴸ,   v = Var w
/// ```
///
/// By Levinson's recursion on `γ_0…γ_L`. Exact where the noise is an autoregression of order `L` or less, as white equation error is, white
/// noise on the output, and equation error that is itself a short autoregression; else the process of greatest entropy with these
/// autocovariances, whose spectrum is near as far as `L` lags show.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Colour {
    /// `d₁…d_L`.
    coefficients: Vec<f64>,
    /// `v`.
    variance: f64,
}

impl Colour {
    /// Stops short of the lag from which on the autocovariances are those of no process (a reflection coefficient of 1 or more).
    pub(super) fn through(gamma: &[f64]) -> Self {
        let mut d: Vec<f64> = Vec::with_capacity(gamma.len());
        let mut variance = gamma[0].max(0.0);
        for k in 1..gamma.len() {
            let ahead: f64 = gamma[k] + d.iter().enumerate().map(|(i, d)| d * gamma[k - 1 - i]).sum::<f64>();
            let reflection = -ahead / variance;
            // Also where there is no noise, and the quotient no number.
            if reflection.is_nan() || reflection.abs() >= 1.0 {
                break;
            }
            let mirrored: Vec<f64> = d.iter().rev().copied().collect();
            d.iter_mut().zip(mirrored).for_each(|(d, m)| *d += reflection * m);
            d.push(reflection);
            variance *= 1.0 - reflection * reflection;
        }
        Self { coefficients: d, variance }
    }

    /// `v`.
    pub(super) fn variance(&self) -> f64 {
        self.variance
    }

    /// `v/S(ω)`.
    pub(super) fn weight(&self, omega: f64) -> f64 {
        power(&self.coefficients, omega)
    }
}

/// `|1 + c₁e^{−jω} + c₂e^{−2jω} + …|²`.
pub(super) fn power(coefficients: &[f64], omega: f64) -> f64 {
    let turned = |(i, c): (usize, &f64)| Complex::from_polar(*c, -omega * (i + 1) as f64);
    (Complex::from(1.0) + coefficients.iter().enumerate().map(turned).sum::<Complex<f64>>()).norm_sqr()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use switchback_model::linear::autocovariance;

    proptest! {
        /// The autocovariances of an autoregression lead back to it, also where more of them are given than it needs.
        #[test]
        fn an_autoregression_is_found_again(p in -0.9..0.9_f64, q in -0.9..0.9_f64, variance in 0.1..3.0_f64, more in 0..4_usize) {
            let ar = [-(p + q), p * q];
            let gamma: Vec<f64> = autocovariance(&ar, &[], 2 + more).iter().map(|g| variance * g).collect();
            let found = Colour::through(&gamma);
            for (i, d) in found.coefficients.iter().enumerate() {
                prop_assert!((d - ar.get(i).copied().unwrap_or(0.0)).abs() < 1e-8, "{:?}", found);
            }
            prop_assert!((found.variance - variance).abs() < 1e-8 * variance);
        }

        /// The spectrum is the sum of the autocovariances that it was made through, and of the others that follow from them.
        #[test]
        fn the_spectrum_has_the_autocovariances(gamma in prop::collection::vec(-0.2..0.2_f64, 3)) {
            let gamma = [&[1.0], gamma.as_slice()].concat();
            let colour = Colour::through(&gamma);
            let lines = 4096;
            for (k, g) in gamma.iter().enumerate() {
                let omega = |j: usize| std::f64::consts::TAU * j as f64 / lines as f64;
                let sum: f64 = (0..lines).map(|j| colour.variance() / colour.weight(omega(j)) * (omega(j) * k as f64).cos()).sum();
                prop_assert!((sum / lines as f64 - g).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn what_is_no_process_is_followed_as_far_as_it_could_be_one() {
        assert_eq!(Colour::through(&[1.0, 1.1]), Colour { coefficients: vec![], variance: 1.0 });
        assert_eq!(Colour::through(&[0.0, 0.0]), Colour { coefficients: vec![], variance: 0.0 });
    }
}
