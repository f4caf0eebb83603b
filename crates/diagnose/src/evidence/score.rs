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

/// Inner products of a group's columns with each other and with the error, and the energy of the error.
#[derive(Debug, Clone)]
struct Products {
    columns: DMatrix<f64>,
    error: DVector<f64>,
    energy: f64,
}

impl Products {
    fn of(gram: &DMatrix<f64>, group: &[usize]) -> Self {
        Self {
            columns: DMatrix::from_fn(group.len(), group.len(), |i, j| gram[(group[i], group[j])]),
            error: DVector::from_fn(group.len(), |i, _| gram[(group[i], 0)]),
            energy: gram[(0, 0)],
        }
    }

    fn none(columns: usize) -> Self {
        Self { columns: DMatrix::zeros(columns, columns), error: DVector::zeros(columns), energy: 0.0 }
    }

    fn plus(self, other: &Self) -> Self {
        Self {
            columns: self.columns + &other.columns,
            error: self.error + &other.error,
            energy: self.energy + other.energy,
        }
    }

    fn less(&self, other: &Self) -> Self {
        Self {
            columns: &self.columns - &other.columns,
            error: &self.error - &other.error,
            energy: self.energy - other.energy,
        }
    }

    /// `(H + ridge)⁻¹g`.
    fn coefficients(&self) -> DVector<f64> {
        let n = self.error.len();
        let ridged = |i: usize, j: usize| match i == j {
            true => self.columns[(i, j)] * (1.0 + RIDGE) + 1e-10,
            false => self.columns[(i, j)],
        };
        let factor = DMatrix::from_fn(n, n, ridged).cholesky();
        factor.map_or_else(|| DVector::zeros(n), |factor| factor.solve(&self.error))
    }

    /// `2cᵀg − cᵀHc`: the part of the error's energy that coefficients take.
    fn taken(&self, c: &DVector<f64>) -> f64 {
        let linear: f64 = self.error.iter().zip(c.iter()).map(|(g, c)| c * g).sum();
        let row = |i: usize| c.iter().enumerate().map(|(j, cj)| cj * self.columns[(i, j)]).sum::<f64>();
        let square: f64 = c.iter().enumerate().map(|(i, ci)| ci * row(i)).sum();
        2.0 * linear - square
    }
}

/// The share that a group explains, and no more.
pub(super) fn share(grams: &Grams, group: &[usize]) -> f64 {
    let total = Products::of(&grams.total, group);
    (total.taken(&total.coefficients()) / grams.energy()).clamp(0.0, 1.0)
}

/// The score of a group.
pub(super) fn score(grams: &Grams, group: &[usize]) -> Score {
    let energy = grams.energy();
    let total = Products::of(&grams.total, group);
    let blocks: Vec<Products> = grams.blocks.iter().map(|block| Products::of(block, group)).collect();
    let c = total.coefficients();
    let mut validated = 0.0;
    let mut of_blocks = Vec::with_capacity(blocks.len());
    for block in &blocks {
        validated += block.taken(&total.less(block).coefficients());
        of_blocks.push(block.taken(&c));
    }
    let count = of_blocks.len() as f64;
    let mean = of_blocks.iter().sum::<f64>() / count;
    let variance = of_blocks.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
    let sum = |is_fitted: bool| {
        let parts = blocks.iter().zip(&grams.is_fitted).filter(|(_, f)| **f == is_fitted);
        parts.fold(Products::none(group.len()), |sum, (part, _)| sum.plus(part))
    };
    let (learnt, others) = (sum(true).coefficients(), sum(false));
    Score {
        share: (total.taken(&c) / energy).clamp(0.0, 1.0),
        validated: validated / energy,
        held_out: others.taken(&learnt) / others.energy.max(1e-12 * energy),
        t: mean / ((variance / count).sqrt() + 1e-9 * energy),
        coefficient: c[0] / energy.sqrt(),
    }
}
