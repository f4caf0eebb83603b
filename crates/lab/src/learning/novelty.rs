//! The subspace of the distance to the training population, by power iteration.

use super::standardised::standard;
use super::table::Table;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;
use switchback_diagnose::posterior::Novelty;

/// Iterations: the leading directions have long settled, the last ones need not be exact.
const ITERATIONS: usize = 8;
/// Of so many rows one is held out, and its distance is one of the quantiles.
const HELD_OUT: usize = 5;
/// Quantiles that are kept.
const QUANTILES: usize = 200;
/// Rows that a thread takes at once.
const TOGETHER: usize = 64;

/// Learns the distance from four rows of five, its quantiles from the fifth.
pub(super) fn learn_novelty(table: &Table, directions: usize) -> Novelty {
    let standard = standard(&table.values);
    let is_held_out = |row: &usize| row % HELD_OUT == HELD_OUT - 1;
    let rows: Vec<Vec<f64>> =
        (0..table.rows()).filter(|r| !is_held_out(r)).map(|r| standard.of(&table.row(r))).collect();
    let columns = table.columns.len();
    let mut mean = vec![0.0; columns];
    rows.iter().for_each(|row| mean.iter_mut().zip(row).for_each(|(m, z)| *m += z / rows.len() as f64));
    let centred: Vec<Vec<f64>> =
        rows.iter().map(|row| row.iter().zip(&mean).map(|(z, m)| z - m).collect()).collect();
    let (directions, variances) = leading(&centred, directions.min(columns));
    let total: f64 = centred.iter().flatten().map(|z| z * z).sum::<f64>() / centred.len().max(1) as f64;
    let left = ((total - variances.iter().sum::<f64>()) / columns.max(1) as f64)
        .max(1e-4 * total / columns.max(1) as f64);
    let short = |x: &[f64]| x.iter().map(|x| *x as f32).collect::<Vec<f32>>();
    let mut novelty = Novelty {
        standard,
        mean: short(&mean),
        directions: directions.iter().map(|d| short(d)).collect(),
        variances: short(&variances),
        left: (left as f32).max(1e-12),
        held_out: Vec::new(),
    };
    let mut distances: Vec<f64> =
        (0..table.rows()).filter(is_held_out).map(|r| novelty.distance(&table.row(r))).collect();
    distances.sort_by(f64::total_cmp);
    if let Some(last) = distances.len().checked_sub(1) {
        let kept = QUANTILES.min(last);
        novelty.held_out = (0..=kept).map(|k| distances[k * last / kept.max(1)] as f32).collect();
    }
    novelty
}

/// Leading eigenvectors of the covariance and their eigenvalues, largest first.
fn leading(rows: &[Vec<f64>], count: usize) -> (Vec<Vec<f64>>, Vec<f64>) {
    let columns = rows.first().map_or(0, Vec::len);
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut basis: Vec<Vec<f64>> =
        (0..count).map(|_| StandardNormal.sample_iter(&mut rng).take(columns).collect()).collect();
    orthonormal(&mut basis);
    let mut variances = vec![0.0; count];
    for _ in 0..ITERATIONS {
        let parts: Vec<Vec<Vec<f64>>> =
            rows.par_chunks(TOGETHER).map(|rows| products(rows, &basis)).collect();
        let mut next = vec![vec![0.0; columns]; count];
        for part in parts {
            for (next, part) in next.iter_mut().zip(part) {
                next.iter_mut().zip(part).for_each(|(n, p)| *n += p / rows.len() as f64);
            }
        }
        for ((variance, next), old) in variances.iter_mut().zip(&next).zip(&basis) {
            *variance = next.iter().zip(old).map(|(n, o)| n * o).sum::<f64>().max(0.0);
        }
        basis = next;
        orthonormal(&mut basis);
    }
    (basis, variances)
}

/// `Σ z·(zᵀe)` of every direction.
fn products(rows: &[Vec<f64>], basis: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut sums = vec![vec![0.0; basis.first().map_or(0, Vec::len)]; basis.len()];
    for row in rows {
        for (sum, direction) in sums.iter_mut().zip(basis) {
            let s: f64 = row.iter().zip(direction).map(|(z, e)| z * e).sum();
            sum.iter_mut().zip(row).for_each(|(sum, z)| *sum += s * z);
        }
    }
    sums
}

/// Gram–Schmidt; a direction that the others span becomes zero.
fn orthonormal(basis: &mut [Vec<f64>]) {
    for k in 0..basis.len() {
        let (before, rest) = basis.split_at_mut(k);
        let one = &mut rest[0];
        let size = one.iter().map(|x| x * x).sum::<f64>().sqrt();
        for other in before {
            let s: f64 = one.iter().zip(other.iter()).map(|(x, y)| x * y).sum();
            one.iter_mut().zip(other.iter()).for_each(|(x, y)| *x -= s * y);
        }
        let norm = one.iter().map(|x| x * x).sum::<f64>().sqrt();
        let scale = if norm > 1e-9 * size { 1.0 / norm } else { 0.0 };
        one.iter_mut().for_each(|x| *x *= scale);
    }
}
