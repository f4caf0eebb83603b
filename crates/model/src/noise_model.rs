//! The autoregressive model of an output's noise, and the filter that makes it white.

/// Coefficients `d₁, d₂, …` of the filter `D(q⁻¹) = 1 + d₁q⁻¹ + …` that makes residuals white: an autoregression whose order minimises
///
/// ```text
/// BIC(k) = N ln σ̂²ₖ + k ln N,    k = 0 … 10 log₁₀ N
/// ```
///
/// with `σ̂²ₖ` the innovation variance by the Yule–Walker equations (Levinson's recursion). None where the residuals are white. `D` has its roots
/// inside the unit circle, so that `1/D` is stable. `residuals` has one list for every stretch of samples without a gap.
///
/// G. Schwarz, Ann. Statist. 6 (1978), doi 10.1214/aos/1176344136; N. Levinson, J. Math. Phys. 25 (1946).
pub fn noise_model(residuals: &[Vec<f64>]) -> Vec<f64> {
    let samples: usize = residuals.iter().map(Vec::len).sum();
    let most = ((10.0 * (samples.max(1) as f64).log10()) as usize).min(samples / 10);
    let covariance = |lag: usize| -> f64 {
        let products = |x: &Vec<f64>| x.iter().zip(x.iter().skip(lag)).map(|(x, z)| x * z).sum::<f64>();
        residuals.iter().map(products).sum::<f64>() / samples as f64
    };
    let covariances: Vec<f64> = (0..=most).map(covariance).collect();
    let count = samples as f64;
    let bic = |order: usize, variance: f64| count * variance.ln() + order as f64 * count.ln();
    let mut best = (bic(0, covariances[0]), Vec::new());
    for (order, (d, variance)) in yule_walker(&covariances).into_iter().enumerate() {
        let criterion = bic(order + 1, variance);
        if criterion < best.0 {
            best = (criterion, d);
        }
    }
    best.1
}

/// The autoregressions of order 1, 2, … that have the given autocovariances, each with its innovation variance; no more once nothing is left to
/// explain.
fn yule_walker(covariances: &[f64]) -> Vec<(Vec<f64>, f64)> {
    let (mut d, mut variance) = (Vec::<f64>::new(), covariances[0]);
    let mut all = Vec::new();
    for order in 1..covariances.len() {
        let ahead: f64 = d.iter().enumerate().map(|(i, d)| d * covariances[order - 1 - i]).sum();
        let reflection = -(covariances[order] + ahead) / variance;
        // Rounding alone, or nothing, is left.
        if reflection.is_nan() || reflection.abs() >= 1.0 {
            break;
        }
        let mirrored: Vec<f64> = d.iter().rev().copied().collect();
        d.iter_mut().zip(mirrored).for_each(|(d, m)| *d += reflection * m);
        d.push(reflection);
        variance *= 1.0 - reflection * reflection;
        all.push((d.clone(), variance));
    }
    all
}

/// `D(q⁻¹)x` of a signal that was zero before, with `D = 1 + d₁q⁻¹ + …`.
pub fn whitened(mut x: Vec<f64>, whitening: &[f64]) -> Vec<f64> {
    // Lag by lag: every sample's sum has the order of the lags, and samples are summed beside each other.
    let mut past = vec![0.0; x.len()];
    for (lag, d) in (1..).zip(whitening).take_while(|(lag, _)| *lag < x.len()) {
        past[lag..].iter_mut().zip(&x).for_each(|(sum, x)| *sum += d * x);
    }
    x.iter_mut().zip(past).for_each(|(x, past)| *x += past);
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::{autocovariance, filter, is_stable};
    use nalgebra::{DMatrix, DVector};
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    fn white(seed: u64, samples: usize) -> Vec<f64> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        (0..samples).map(|_| StandardNormal.sample(&mut rng)).collect()
    }

    #[test]
    fn the_recursion_solves_the_yule_walker_equations() {
        let covariances = autocovariance(&[-0.9, 0.5, -0.2], &[0.4, 0.3], 6);
        for (d, variance) in yule_walker(&covariances) {
            let order = d.len();
            let matrix = DMatrix::from_fn(order, order, |i, j: usize| covariances[i.abs_diff(j)]);
            let dense = -matrix.lu().solve(&DVector::from_column_slice(&covariances[1..=order])).unwrap();
            assert!((DVector::from_vec(d.clone()) - &dense).amax() < 1e-12);
            let left = covariances[0] + dense.dot(&DVector::from_column_slice(&covariances[1..=order]));
            assert!((variance - left).abs() < 1e-12 && is_stable(&d));
        }
    }

    #[test]
    fn white_residuals_need_no_filter_and_coloured_ones_theirs() {
        let mut coloured = 0;
        for seed in 0..50 {
            coloured += usize::from(!noise_model(&[white(seed, 3000), white(seed + 100, 2000)]).is_empty());
        }
        // P(χ²₁ > ln 5000) is 0.35 %, and higher orders add as much again.
        assert!(coloured <= 3, "{coloured} of 50 taken for coloured");
        let ar = [-1.2, 0.45];
        let found = noise_model(&[filter(&ar, &[0.0], &vec![0.0; 20_000], &white(7, 20_000), 0.0, 0.0)]);
        assert_eq!(found.len(), 2, "{found:?}");
        // Asymptotic standard errors √((1 − a₂²)/N).
        for (found, truth) in found.iter().zip(ar) {
            assert!(
                (found - truth).abs() < 4.0 * f64::sqrt((1.0 - 0.45 * 0.45) / 20_000.0),
                "{found} {truth}"
            );
        }
    }
}
