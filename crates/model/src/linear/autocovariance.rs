//! Stationary autocovariances of filtered white noise.

use nalgebra::{DMatrix, DVector};

/// Autocovariances `γ(0)…γ(lags)` of `e = C(q⁻¹)/A(q⁻¹) w`, `w` unit white noise.
///
/// ```text
/// γ(k) + Σᵢ aᵢ γ(k−i) = Σ_{j≥k} c_j h_{j−k},   h = impulse response of C/A,  c₀ = 1
/// ```
///
/// (the Yule–Walker equations of an ARMA process; Box and Jenkins, "Time Series Analysis", ch. 3). `a` holds `a₁…aₙ`, `c`
/// holds `c₁…`. Solves one linear system of size `max(n, deg C) + 1`.
///
/// # Panics
/// If the system is singular, that is if `A` is on the stability limit.
///
/// ```
/// # use switchback_model::linear::autocovariance;
/// let gamma = autocovariance(&[-0.8], &[], 2);
/// assert!((gamma[0] - 1.0 / (1.0 - 0.64)).abs() < 1e-12 && (gamma[2] - 0.64 * gamma[0]).abs() < 1e-12);
/// ```
pub fn autocovariance(a: &[f64], c: &[f64], lags: usize) -> Vec<f64> {
    let ma: Vec<f64> = std::iter::once(1.0).chain(c.iter().copied()).collect();
    let mut impulse: Vec<f64> = Vec::with_capacity(ma.len());
    for j in 0..ma.len() {
        let past: f64 = a.iter().take(j).enumerate().map(|(i, ai)| ai * impulse[j - i - 1]).sum();
        impulse.push(ma[j] - past);
    }
    let forcing = |k: usize| (k..ma.len()).map(|j| ma[j] * impulse[j - k]).sum::<f64>();

    let size = a.len().max(c.len()) + 1;
    let mut equations = DMatrix::<f64>::identity(size, size);
    for k in 0..size {
        for (i, ai) in a.iter().enumerate() {
            equations[(k, k.abs_diff(i + 1))] += ai;
        }
    }
    let right = DVector::from_fn(size, |k, _| forcing(k));
    let solved = equations.lu().solve(&right).expect("A is strictly stable");
    let mut gamma: Vec<f64> = solved.iter().copied().collect();
    for k in size..=lags {
        let past: f64 = a.iter().enumerate().map(|(i, ai)| ai * gamma[k - i - 1]).sum();
        gamma.push(forcing(k) - past);
    }
    gamma.truncate(lags + 1);
    gamma
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn agrees_with_the_sum_over_the_impulse_response(p in -0.9..0.9_f64, q in -0.9..0.9_f64, c in -0.9..0.9_f64, d in -0.9..0.9_f64, e in -0.5..0.5_f64) {
            let a = [-(p + q), p * q];
            let ma = [c, d, e];
            let mut h: Vec<f64> = Vec::new();
            for j in 0..600 {
                let driven = if j == 0 { 1.0 } else { ma.get(j - 1).copied().unwrap_or(0.0) };
                let past: f64 = (0..2).filter(|i| j > *i).map(|i| a[i] * h[j - i - 1]).sum();
                h.push(driven - past);
            }
            let gamma = autocovariance(&a, &ma, 6);
            prop_assert_eq!(gamma.len(), 7);
            for (k, g) in gamma.iter().enumerate() {
                let direct: f64 = (0..600 - k).map(|j| h[j] * h[j + k]).sum();
                prop_assert!((g - direct).abs() < 1e-9 * gamma[0], "lag {}: {} against {}", k, g, direct);
            }
        }
    }
}
