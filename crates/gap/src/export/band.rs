//! How far the parameters' errors move a free run.

use nalgebra::DMatrix;

use super::portable::Wire;
use crate::model::linear::Linear;

/// Share of a standard error by which parameters are moved for the derivatives: small enough for any curvature, large enough for
/// the rounding of a run.
const STEP: f64 = 1e-3;
/// Share of the largest variance (of standardised parameters) below which a direction is rounding.
const NOTHING: f64 = 1e-13;

/// Variance of every sample of a free run that the errors of the parameters make: `Σ_k (∂y/∂θ·l_k)²` over the columns of a root
/// `C = Σ_k l_k l_kᵀ` of their covariance, by central differences.
///
/// `run` gives the output for linear parameters; `moved` the run under the moved assembly of each own parameter.
pub(super) fn variances(
    model: &Wire,
    linear: &Linear,
    run: impl Fn(&Linear) -> Vec<f64>,
    moved: impl Fn(usize) -> Vec<f64>,
) -> Option<Vec<f64>> {
    let rows = model.covariance.as_ref()?;
    let fitted = run(linear);
    let slopes: Vec<Vec<f64>> = (0..model.moved.len())
        .map(|j| moved(j).iter().zip(&fitted).map(|(m, y)| (m - y) / model.moved[j].step).collect())
        .collect();
    let mut sum = vec![0.0; fitted.len()];
    for direction in root(rows) {
        let (by, own) = direction.split_at(linear.len());
        let [up, down] = [STEP, -STEP].map(|share| run(&linear.moved(by, share)));
        for (t, sum) in sum.iter_mut().enumerate() {
            let along: f64 = own.iter().zip(&slopes).map(|(by, slope)| by * slope[t]).sum();
            *sum += ((up[t] - down[t]) / (2.0 * STEP) + along).powi(2);
        }
    }
    Some(sum)
}

/// Columns `l_k` with `C = Σ l_k l_kᵀ`, given the lower triangle; from the eigenvectors of the correlations, which may be singular.
fn root(rows: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let p = rows.len();
    let sd: Vec<f64> = (0..p).map(|i| rows[i][i].max(0.0).sqrt()).collect();
    let correlation = DMatrix::from_fn(p, p, |i, j| {
        let scale = sd[i] * sd[j];
        if scale > 0.0 { rows[i.max(j)][i.min(j)] / scale } else { 0.0 }
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
        let rows = vec![vec![4.0], vec![2.0, 1.0], vec![0.0, 0.0, 9.0]];
        let columns = root(&rows);
        assert_eq!(columns.len(), 2);
        for i in 0..3 {
            for j in 0..=i {
                let product: f64 = columns.iter().map(|l| l[i] * l[j]).sum();
                assert!((product - rows[i][j]).abs() < 1e-12, "{i} {j}: {product}");
            }
        }
    }
}
