//! Spectral factorisation of short moving averages.

/// `C`, monic and minimum phase, with `|C|² ∝ 1 + ratio·|A|²` on the unit circle; `c₁…cₙ` are returned.
///
/// White output noise `w` with `ratio` times the variance of the equation error `ξ` enters the equation as
/// `ξ + A w`, a moving average of order `n`. Found by Bauer's method: the last row of the Cholesky factor of the banded
/// Toeplitz covariance converges to `C`.
pub(crate) fn factor_of_sum(ratio: f64, a: &[f64]) -> Vec<f64> {
    let n = a.len();
    let full: Vec<f64> = std::iter::once(1.0).chain(a.iter().copied()).collect();
    let covariance: Vec<f64> = (0..=n)
        .map(|lag| {
            let product: f64 = (0..=n - lag).map(|i| full[i] * full[i + lag]).sum();
            ratio * product + if lag == 0 { 1.0 } else { 0.0 }
        })
        .collect();
    // Rows of the factor: l[i][k] multiplies the innovation k samples before i.
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for i in 0..200 {
        let mut row = vec![0.0; n + 1];
        for lag in (0..=n.min(i)).rev() {
            let j = i - lag;
            let mut sum = covariance[lag];
            for m in lag + 1..=n.min(i) {
                // Innovation i − m: its weight in row i, and in row j at distance m − lag.
                if m - lag <= n.min(j) {
                    sum -= row[m] * if lag == 0 { row[m] } else { rows[j][m - lag] };
                }
            }
            row[lag] = if lag == 0 { sum.max(1e-300).sqrt() } else { sum / rows[j][0] };
        }
        let settled = rows.last().is_some_and(|last: &Vec<f64>| {
            i > n && last.iter().zip(&row).all(|(x, y)| (x - y).abs() < 1e-12 * row[0])
        });
        rows.push(row);
        if settled {
            break;
        }
    }
    let last = &rows[rows.len() - 1];
    last[1..].iter().map(|x| x / last[0]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_factor_reproduces_the_covariance() {
        let a = [-1.2, 0.5];
        let c = factor_of_sum(2.0, &a);
        let full = [1.0, c[0], c[1]];
        let covariance = |lag: usize| (0..3 - lag).map(|i| full[i] * full[i + lag]).sum::<f64>();
        let a_full = [1.0, -1.2, 0.5];
        let target = |lag: usize| {
            2.0 * (0..3 - lag).map(|i| a_full[i] * a_full[i + lag]).sum::<f64>()
                + f64::from(u8::from(lag == 0))
        };
        let scale = target(0) / covariance(0);
        for lag in 0..3 {
            assert!((scale * covariance(lag) - target(lag)).abs() < 1e-9);
        }
    }
}
