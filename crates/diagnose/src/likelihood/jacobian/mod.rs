//! Derivatives of the innovations with respect to the linear parameters, one row a counted sample.
//!
//! ```text
//! ∂e(t)/∂aᵢ = x(t−i),  ∂e/∂bⱼ = −(taps ∗ ũ)(t−j),  ∂e/∂f = −Σ b̃ⱼ·rows(t−j)/den,  ∂e/∂d = −ψ(t);   ∂w = D/C·∂e
//! ```
//!
//! A hat function touches two border values, so rows are sparse unless a recursive filter spreads them.

mod dense;
mod sparse;
mod tapped;

pub(crate) use self::dense::filtered_rows;
use self::dense::{Active, dense_rows};
use self::sparse::sparse_rows;
use crate::least_squares::dense_sums::DenseSums;
use crate::least_squares::mixed_sums::MixedSums;
use crate::least_squares::normal::Normal;
use crate::likelihood::design::{Design, DesignScaled};
use crate::likelihood::rows::Rows;
use crate::likelihood::weights::Weights;
use crate::likelihood::whitener::Whitener;
use crate::model::linear::Linear;

/// Weighted derivatives, all records one after the other.
#[derive(Debug, Clone)]
pub(crate) struct Jacobian {
    columns: usize,
    store: Store,
}

#[derive(Debug, Clone)]
enum Store {
    /// Those of `A` and `B`, `width` a row; the rest from the first border value on.
    Sparse { width: usize, dynamics: Vec<f64>, others: Rows },
    /// Row-major.
    Dense(Vec<f64>),
}

impl Jacobian {
    /// The derivatives at `p`; each row times its weight.
    pub(crate) fn new(design: &Design, p: &Linear, whitener: &Whitener, weights: &Weights) -> Self {
        design.pass_begins();
        let columns = p.len();
        let store = if spreads(design, whitener, weights) {
            let mut out = vec![0.0; design.samples() * columns];
            let mut rows = out.chunks_exact_mut(columns);
            for (number, scaled) in design.scaled_records.iter().enumerate() {
                let active = Active::on(scaled, p);
                let parameters = active.parameters(p);
                let mut weigh = weights.rows(number, parameters.len());
                dense_rows((design, scaled), p, whitener, &active, |row| {
                    weigh(row);
                    if let Some(out) = rows.next() {
                        parameters.iter().zip(row).for_each(|(&i, x)| out[i] = *x);
                    }
                });
            }
            Store::Dense(out)
        } else {
            let mut others = Rows::with_capacity(design.samples());
            let width = p.a.len() + p.b.len();
            let mut dynamics = Vec::with_capacity(design.samples() * width);
            for (scaled, factors) in effect_terms(design, weights) {
                sparse_rows((design, scaled), p, whitener, factors, |row| {
                    dynamics.extend_from_slice(&row.dynamics);
                    others.push(&row.others, 1.0);
                });
            }
            Store::Sparse { width, dynamics, others }
        };
        Self { columns, store }
    }

    /// `Σ x xᵀ` and `Σ x w` for weighted innovations `w`.
    pub(crate) fn normal(&self, w: &[f64]) -> Normal {
        let mut normal = Normal::new(self.columns);
        match &self.store {
            Store::Sparse { width, dynamics, others } => {
                let mut sums = MixedSums::new((0..*width).collect(), *width..self.columns);
                for (t, (dynamics, &w)) in dynamics.chunks_exact(*width).zip(w).enumerate() {
                    sums.push(dynamics, std::iter::empty(), others.row(t), w);
                }
                sums.add_to(&mut normal);
            }
            Store::Dense(rows) => {
                let mut sums = DenseSums::new((0..self.columns).collect());
                for (row, &w) in rows.chunks_exact(self.columns).zip(w) {
                    sums.push(row, std::iter::empty(), w);
                }
                sums.add_to(&mut normal);
            }
        }
        normal
    }

    /// `Σ x·c` for a weighted column `c` that begins at the row `first`; zeros of `c` cost a comparison.
    pub(crate) fn cross(&self, first: usize, column: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.columns];
        for (t, &c) in column.iter().enumerate().filter(|(_, c)| **c != 0.0) {
            self.add_row(first + t, c, &mut out);
        }
        out
    }

    /// `sum += scale·row(t)`.
    pub(crate) fn add_row(&self, t: usize, scale: f64, sum: &mut [f64]) {
        match &self.store {
            Store::Sparse { width, dynamics, others } => {
                let (first, rest) = sum.split_at_mut(*width);
                for (sum, x) in first.iter_mut().zip(&dynamics[t * width..]) {
                    *sum += x * scale;
                }
                for &(i, x) in others.row(t) {
                    rest[i as usize] += x * scale;
                }
            }
            Store::Dense(rows) => {
                let row = &rows[t * self.columns..(t + 1) * self.columns];
                for (o, x) in sum.iter_mut().zip(row) {
                    *o += x * scale;
                }
            }
        }
    }
}

/// `Σ x xᵀ` and `Σ x w` of the derivatives at `p` with the columns of `extra` appended, innovations `w`, everything weighted.
/// No row is kept.
pub(crate) fn normal_equations(
    design: &Design,
    p: &Linear,
    whitener: &Whitener,
    weights: &Weights,
    (w, extra): (&[f64], &[Vec<f64>]),
) -> Normal {
    design.pass_begins();
    let columns = p.len();
    let width = columns + extra.len();
    let mut normal = Normal::new(width);
    let dynamics = p.a.len() + p.b.len();
    let mut sums = MixedSums::new((0..dynamics).chain(columns..width).collect(), dynamics..columns);
    let mut row_number = 0;
    for (number, (scaled, factors)) in effect_terms(design, weights).enumerate() {
        if spreads(design, whitener, weights) {
            let active = Active::on(scaled, p);
            let parameters = active.parameters(p);
            let mut weigh = weights.rows(number, parameters.len());
            let mut sums = DenseSums::new(parameters.into_iter().chain(columns..width).collect());
            dense_rows((design, scaled), p, whitener, &active, |row| {
                weigh(row);
                sums.push(row, extra.iter().map(|column| column[row_number]), w[row_number]);
                row_number += 1;
            });
            sums.add_to(&mut normal);
        } else {
            sparse_rows((design, scaled), p, whitener, factors, |row| {
                let extra = extra.iter().map(|column| column[row_number]);
                sums.push(&row.dynamics, extra, &row.others, w[row_number]);
                row_number += 1;
            });
        }
    }
    sums.add_to(&mut normal);
    normal
}

/// Whether a recursive filter spreads the border features over whole rows.
fn spreads(design: &Design, whitener: &Whitener, weights: &Weights) -> bool {
    !design.poles.is_empty() || !whitener.ma.is_empty() || weights.predictors.is_some()
}

/// Tracks with the weights of their counted samples.
fn effect_terms<'a>(
    design: &'a Design,
    weights: &'a Weights,
) -> impl Iterator<Item = (&'a DesignScaled, Option<&'a [f64]>)> {
    let factors = |k: usize| weights.scale.as_ref().map(|s| &s[k][..]);
    design.scaled_records.iter().enumerate().map(move |(k, scaled)| (scaled, factors(k)))
}

#[cfg(test)]
mod tests;
