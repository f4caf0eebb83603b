//! How much of the error a group of columns explains.

use super::grams::Grams;
use nalgebra::{DMatrix, DVector};

/// Shares of the energy of the error.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Score {
    /// Explained by the group.
    pub(super) share: f64,
    /// Explained in each block by coefficients of the others, summed.
    pub(super) validated: f64,
    /// Explained in the blocks that were not fitted, by coefficients of those that were, over their energy.
    pub(super) held_out: f64,
    /// Mean over blocks of what is explained there, over its standard error.
    pub(super) t: f64,
    /// Coefficient of the first column over the norm of the error.
    pub(super) coefficient: f64,
}

/// Ridge of a group's coefficients, relative to the norms of its columns.
const RIDGE: f64 = 1e-4;

/// Inner products of the error, first, and of a group's columns.
fn of_group(gram: &DMatrix<f64>, group: &[usize]) -> DMatrix<f64> {
    let at = |i: usize| if i == 0 { 0 } else { group[i - 1] };
    DMatrix::from_fn(group.len() + 1, group.len() + 1, |i, j| gram[(at(i), at(j))])
}

/// `(H + ridge)⁻¹g`.
fn coefficients(products: &DMatrix<f64>) -> DVector<f64> {
    let n = products.nrows() - 1;
    let mut h = products.view((1, 1), (n, n)).into_owned();
    (0..n).for_each(|i| h[(i, i)] = h[(i, i)] * (1.0 + RIDGE) + 1e-10);
    let right = products.column(0).rows(1, n).into_owned();
    h.cholesky().map_or_else(|| DVector::zeros(n), |factor| factor.solve(&right))
}

/// `2cᵀg − cᵀHc`: the part of the error's energy that coefficients take.
fn taken(products: &DMatrix<f64>, c: &DVector<f64>) -> f64 {
    let along = |row: usize| (1..).zip(c.iter()).map(|(j, c)| c * products[(row, j)]).sum::<f64>();
    let square: f64 = (1..).zip(c.iter()).map(|(i, c)| c * along(i)).sum();
    2.0 * along(0) - square
}

/// The share that a group explains, and no more.
pub(super) fn share(grams: &Grams, group: &[usize]) -> f64 {
    let total = of_group(&grams.total, group);
    (taken(&total, &coefficients(&total)) / grams.energy()).clamp(0.0, 1.0)
}

/// The score of a group.
pub(super) fn score(grams: &Grams, group: &[usize]) -> Score {
    let energy = grams.energy();
    let total = of_group(&grams.total, group);
    let blocks: Vec<DMatrix<f64>> = grams.blocks.iter().map(|block| of_group(block, group)).collect();
    let c = coefficients(&total);
    let validated: f64 = blocks.iter().map(|block| taken(block, &coefficients(&(&total - block)))).sum();
    let of_blocks: Vec<f64> = blocks.iter().map(|block| taken(block, &c)).collect();
    let count = of_blocks.len() as f64;
    let mean = of_blocks.iter().sum::<f64>() / count;
    let variance = of_blocks.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
    let sum = |is_fitted: bool| {
        let parts = blocks.iter().zip(&grams.is_fitted).filter(|(_, f)| **f == is_fitted);
        parts.fold(DMatrix::zeros(total.nrows(), total.ncols()), |sum, (part, _)| sum + part)
    };
    let (learnt, others) = (coefficients(&sum(true)), sum(false));
    Score {
        share: (taken(&total, &c) / energy).clamp(0.0, 1.0),
        validated: validated / energy,
        held_out: taken(&others, &learnt) / others[(0, 0)].max(1e-12 * energy),
        t: mean / ((variance / count).sqrt() + 1e-9 * energy),
        coefficient: c[0] / energy.sqrt(),
    }
}
