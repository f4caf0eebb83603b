//! From the covariance of parameters to the variance of what is computed from them.

use nalgebra::DMatrix;

/// Share of a standard error by which parameters are moved: small against any curvature, large against the rounding of a run.
const STEP: f64 = 1e-3;
/// Share of the largest eigenvalue (of the correlations) below which a direction is rounding.
const NOTHING: f64 = 1e-13;

/// Variance of every entry of `f(θ)` that errors of `θ` with a given covariance make, to first order:
///
/// ```text
/// Σ_k (∂f/∂θ · l_k)²,   C = Σ_k l_k l_kᵀ
/// ```
///
/// by central differences along the columns `l_k` of a root of `C`. `lower` holds the rows of its lower triangle, `moved` gives `f` at `θ`
/// moved by a step. `C` may be singular. Two calls of `moved` a parameter.
///
/// ```
/// use switchback_identify::statistics::propagated;
/// // The sum and the difference of two parameters with correlated errors.
/// let lower = [vec![4.0], vec![1.0, 1.0]];
/// let variances = propagated(&lower, |by| vec![by[0] + by[1], by[0] - by[1]]);
/// assert!((variances[0] - 7.0).abs() < 1e-9 && (variances[1] - 3.0).abs() < 1e-9);
/// ```
pub fn propagated(lower: &[Vec<f64>], moved: impl Fn(&[f64]) -> Vec<f64>) -> Vec<f64> {
    let mut sum: Vec<f64> = Vec::new();
    for direction in root(lower) {
        let [up, down] = [STEP, -STEP].map(|share| {
            let step: Vec<f64> = direction.iter().map(|x| share * x).collect();
            moved(&step)
        });
        sum.resize(up.len(), 0.0);
        for ((sum, up), down) in sum.iter_mut().zip(up).zip(down) {
            *sum += ((up - down) / (2.0 * STEP)).powi(2);
        }
    }
    sum
}

/// Columns `l_k` with `C = Σ l_k l_kᵀ`, from the eigenvectors of the correlations.
fn root(lower: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let p = lower.len();
    if p == 0 {
        return Vec::new();
    }
    let sd: Vec<f64> = (0..p).map(|i| lower[i][i].max(0.0).sqrt()).collect();
    let correlation = DMatrix::from_fn(p, p, |i, j| {
        let scale = sd[i] * sd[j];
        if scale > 0.0 { lower[i.max(j)][i.min(j)] / scale } else { 0.0 }
    });
    let eigen = correlation.symmetric_eigen();
    let most = eigen.eigenvalues.iter().fold(0.0, |most: f64, x| most.max(*x));
    let counted = (0..p).filter(|&k| eigen.eigenvalues[k] > NOTHING * most);
    counted
        .map(|k| {
            let size = eigen.eigenvalues[k].sqrt();
            (0..p).map(|i| sd[i] * size * eigen.eigenvectors[(i, k)]).collect()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_root_gives_the_covariance_back_though_it_is_singular() {
        // Two parameters that err alike, and one on its own.
        let rows = [vec![4.0], vec![2.0, 1.0], vec![0.0, 0.0, 9.0]];
        let columns = root(&rows);
        assert_eq!(columns.len(), 2);
        for i in 0..3 {
            for j in 0..=i {
                let product: f64 = columns.iter().map(|l| l[i] * l[j]).sum();
                assert!((product - rows[i][j]).abs() < 1e-12, "{i} {j}: {product}");
            }
        }
    }

    #[test]
    fn curvature_is_not_seen_and_no_parameter_no_variance() {
        let square = propagated(&[vec![0.01]], |by| vec![(2.0 + by[0]).powi(2)]);
        assert!((square[0] - 16.0 * 0.01).abs() < 1e-9, "{square:?}");
        assert!(propagated(&[], |_| vec![1.0]).is_empty());
    }
}
