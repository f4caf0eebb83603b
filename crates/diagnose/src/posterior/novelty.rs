//! How far a row lies from the rows that a posterior was trained on.

use super::bytes::{Reader, Writer};
use super::error::PosteriorError;
use super::standard::Standard;

/// A Mahalanobis distance in a subspace of few directions, and the distance from that subspace:
///
/// ```text
/// d² = ½·(1/k)·Σ_j s_j²/(λ_j + ρ) + ½·‖z − Σ_j s_j e_j‖²/(m·ρ),   s_j = e_jᵀ(z − mean)
/// ```
///
/// with `k` directions `e_j` of variances `λ_j` of `m` standardised columns, and `ρ` the mean variance that they leave.
#[derive(Debug, Clone, PartialEq)]
pub struct Novelty {
    /// Scales of the columns.
    pub standard: Standard,
    /// Mean of the standardised columns.
    pub mean: Vec<f32>,
    /// Orthonormal directions.
    pub directions: Vec<Vec<f32>>,
    /// Variance along each.
    pub variances: Vec<f32>,
    /// Mean variance of a column that they leave, positive.
    pub left: f32,
    /// Distances of rows that were held out, increasing.
    pub held_out: Vec<f32>,
}

impl Novelty {
    /// The distance of a row.
    pub fn distance(&self, row: &[f64]) -> f64 {
        let z = self.standard.of(row);
        let mut rest: Vec<f64> = z.iter().zip(&self.mean).map(|(z, m)| z - f64::from(*m)).collect();
        let rho = f64::from(self.left);
        let mut within = 0.0;
        for (direction, variance) in self.directions.iter().zip(&self.variances) {
            let s: f64 = rest.iter().zip(direction).map(|(z, e)| z * f64::from(*e)).sum();
            rest.iter_mut().zip(direction).for_each(|(z, e)| *z -= s * f64::from(*e));
            within += s * s / (f64::from(*variance) + rho);
        }
        let beyond = rest.iter().map(|z| z * z).sum::<f64>() / (rest.len().max(1) as f64 * rho);
        (0.5 * within / self.directions.len().max(1) as f64 + 0.5 * beyond).sqrt()
    }

    /// The share of held-out rows that lie nearer.
    pub fn quantile(&self, row: &[f64]) -> f64 {
        let distance = self.distance(row);
        let nearer = self.held_out.partition_point(|d| f64::from(*d) < distance);
        nearer as f64 / self.held_out.len().max(1) as f64
    }

    pub(super) fn write(&self, out: &mut Writer) {
        self.standard.write(out);
        out.numbers(&self.mean);
        out.numbers(&self.variances);
        self.directions.iter().for_each(|direction| out.numbers(direction));
        out.number(self.left);
        out.numbers(&self.held_out);
    }

    pub(super) fn read(from: &mut Reader<'_>, columns: usize) -> Result<Self, PosteriorError> {
        let standard = Standard::read(from, columns)?;
        let (mean, variances) = (from.numbers()?, from.numbers()?);
        let directions = variances.iter().map(|_| from.numbers()).collect::<Result<Vec<_>, _>>()?;
        let (left, held_out) = (from.number()?, from.numbers()?);
        let fits = mean.len() == columns && directions.iter().all(|direction| direction.len() == columns);
        if !fits || left <= 0.0 || variances.iter().any(|v| *v < 0.0) || !held_out.is_sorted() {
            return Err(from.damaged("distances of other columns"));
        }
        Ok(Self { standard, mean, directions, variances, left, held_out })
    }
}
