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

fn coefficients(gram: &DMatrix<f64>, group: &[usize]) -> DVector<f64> {
    let n = group.len();
    let h = DMatrix::from_fn(n, n, |i, j| {
        gram[(group[i], group[j])] * if i == j { 1.0 + RIDGE } else { 1.0 } + if i == j { 1e-10 } else { 0.0 }
    });
    let right = DVector::from_fn(n, |i, _| gram[(group[i], 0)]);
    h.cholesky().map_or_else(|| DVector::zeros(n), |factor| factor.solve(&right))
}

/// `2cᵀg − cᵀHc`: what coefficients take from the energy of the error.
fn taken(gram: &DMatrix<f64>, group: &[usize], c: &DVector<f64>) -> f64 {
    let linear: f64 = group.iter().zip(c.iter()).map(|(k, c)| c * gram[(*k, 0)]).sum();
    let square: f64 = group
        .iter()
        .zip(c.iter())
        .map(|(i, ci)| ci * group.iter().zip(c.iter()).map(|(j, cj)| cj * gram[(*i, *j)]).sum::<f64>())
        .sum();
    2.0 * linear - square
}

/// The share that a group explains, and no more.
pub(super) fn share(grams: &Grams, group: &[usize]) -> f64 {
    (taken(&grams.total, group, &coefficients(&grams.total, group)) / grams.energy()).clamp(0.0, 1.0)
}

/// The score of a group.
pub(super) fn score(grams: &Grams, group: &[usize]) -> Score {
    let energy = grams.energy();
    let c = coefficients(&grams.total, group);
    let mut validated = 0.0;
    let mut of_blocks = Vec::with_capacity(grams.blocks.len());
    for block in &grams.blocks {
        let others = coefficients(&(&grams.total - block), group);
        validated += taken(block, group, &others);
        of_blocks.push(taken(block, group, &c));
    }
    let count = of_blocks.len() as f64;
    let mean = of_blocks.iter().sum::<f64>() / count;
    let variance = of_blocks.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
    let zero = || DMatrix::zeros(grams.total.nrows(), grams.total.ncols());
    let sum = |is_fitted: bool| {
        let parts = grams.blocks.iter().zip(&grams.is_fitted).filter(|(_, f)| **f == is_fitted);
        parts.fold(zero(), |sum, (part, _)| sum + part)
    };
    let (fitted, others) = (sum(true), sum(false));
    let learnt = coefficients(&fitted, group);
    Score {
        share: (taken(&grams.total, group, &c) / energy).clamp(0.0, 1.0),
        validated: validated / energy,
        held_out: taken(&others, group, &learnt) / others[(0, 0)].max(1e-12 * energy),
        t: mean / ((variance / count).sqrt() + 1e-9 * energy),
        coefficient: c[0] / energy.sqrt(),
    }
}
