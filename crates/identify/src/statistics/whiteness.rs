//! Whether a residual is noise: what its own past predicts of it.

use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Lags that are looked at.
const LAGS: usize = 20;

/// How far a residual is from white noise.
///
/// ```text
/// Q = N(N+2) Σ_k r_k²/(N−k),   k = 1…20          Ljung–Box; χ² with 20 degrees of freedom if the residual is white
/// R² = 1 − s²/(N−20) / (c₀/N)                     s² the sum of squares that an autoregression of order 20 leaves
/// ```
///
/// `Q` says whether there is colour at all, and in a long record there always is; `R²` says how much. G. M. Ljung, G. E. P. Box, Biometrika 65
/// (1978), doi 10.1093/biomet/65.2.297.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Whiteness {
    /// `Q`.
    pub ljung_box: f64,
    /// Probability of a `Q` this large in white noise.
    pub p_value: f64,
    /// `R²`, the share of the variance that the past predicts; not below 0.
    pub forecast: f64,
    /// Lags behind both figures.
    pub lags: usize,
}

impl Whiteness {
    /// From the residuals of several records, none of which follows on another; `None` below ten samples a lag, or where nothing moves.
    ///
    /// The residuals are taken about zero: a constant error is an error.
    ///
    /// ```
    /// use switchback_identify::statistics::Whiteness;
    /// // A ramp's next value is known from its last ones.
    /// let ramp: Vec<f64> = (0..400).map(|t| f64::from(t) - 200.0).collect();
    /// assert!(Whiteness::of(&[&ramp]).unwrap().forecast > 0.95);
    /// ```
    pub fn of(residuals: &[&[f64]]) -> Option<Self> {
        let count: usize = residuals.iter().map(|r| r.len()).sum();
        if count < 10 * LAGS {
            return None;
        }
        let lagged = |lag: usize| -> f64 {
            let products = |r: &&[f64]| r.iter().zip(r.iter().skip(lag)).map(|(x, z)| x * z).sum::<f64>();
            residuals.iter().map(products).sum()
        };
        let covariance: Vec<f64> = (0..=LAGS).map(lagged).collect();
        if !(covariance[0] > 0.0 && covariance[0].is_finite()) {
            return None;
        }
        let n = count as f64;
        let part = |k: usize| (covariance[k] / covariance[0]).powi(2) / (n - k as f64);
        let ljung_box = n * (n + 2.0) * (1..=LAGS).map(part).sum::<f64>();
        let chi_squared = ChiSquared::new(LAGS as f64).ok()?;
        let left = innovation_share(&covariance) / covariance[0];
        let forecast = 1.0 - left * n / (n - LAGS as f64);
        Some(Self { ljung_box, p_value: chi_squared.sf(ljung_box), forecast: forecast.max(0.0), lags: LAGS })
    }
}

/// Sum of squares that the autoregression of full order leaves of one with these lagged products (Levinson's recursion).
fn innovation_share(covariance: &[f64]) -> f64 {
    let mut left = covariance[0];
    let mut a: Vec<f64> = Vec::with_capacity(covariance.len());
    for k in 1..covariance.len() {
        let ahead: f64 = a.iter().enumerate().map(|(i, a)| a * covariance[k - 1 - i]).sum();
        let reflection = (covariance[k] - ahead) / left;
        let earlier = a.clone();
        a.iter_mut().zip(earlier.iter().rev()).for_each(|(a, mirrored)| *a -= reflection * mirrored);
        a.push(reflection);
        left *= 1.0 - reflection * reflection;
        // A residual without noise of its own is predicted to the last digit.
        if left <= f64::EPSILON * covariance[0] {
            return 0.0;
        }
    }
    left
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    fn white(seed: u64, count: usize) -> Vec<f64> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        (0..count).map(|_| rng.random_range(-1.0..1.0)).collect()
    }

    /// `x(t) = pole·x(t−1) + w(t)`: the past predicts `pole²` of the variance.
    fn coloured(seed: u64, count: usize, pole: f64) -> Vec<f64> {
        let mut x = white(seed, count);
        for t in 1..count {
            x[t] += pole * x[t - 1];
        }
        x
    }

    #[test]
    fn white_noise_is_rejected_as_often_as_the_level_says_and_nothing_is_forecast() {
        let tests: Vec<Whiteness> =
            (0..400).map(|seed| Whiteness::of(&[&white(seed, 1000)]).unwrap()).collect();
        let rejected = tests.iter().filter(|w| w.p_value < 0.05).count();
        // 20 expected, standard deviation 4.4.
        assert!((4..=36).contains(&rejected), "{rejected} of 400");
        let forecast = tests.iter().map(|w| w.forecast).sum::<f64>() / 400.0;
        assert!(forecast < 0.01, "{forecast}");
    }

    #[test]
    fn an_autoregression_is_forecast_by_the_square_of_its_pole() {
        let [one, other] = [coloured(1, 20_000, 0.6), coloured(2, 20_000, 0.6)];
        let found = Whiteness::of(&[&one, &other]).unwrap();
        assert!((found.forecast - 0.36).abs() < 0.02, "{found:?}");
        assert!(found.p_value < 1e-9);
    }

    #[test]
    fn the_recursion_solves_the_normal_equations() {
        let x = coloured(3, 500, 0.7);
        let products: Vec<f64> =
            (0..=LAGS).map(|k| x.iter().zip(x.iter().skip(k)).map(|(x, z)| x * z).sum()).collect();
        let matrix = DMatrix::from_fn(LAGS, LAGS, |i, j| products[i.abs_diff(j)]);
        let right = DVector::from_column_slice(&products[1..]);
        let solved = matrix.cholesky().unwrap().solve(&right);
        let left = products[0] - solved.dot(&right);
        assert!((innovation_share(&products) / left - 1.0).abs() < 1e-9);
    }

    #[test]
    fn too_little_data_give_no_figure() {
        assert_eq!(Whiteness::of(&[&white(1, 150)]), None);
        assert_eq!(Whiteness::of(&[&[0.0; 500]]), None);
    }
}
