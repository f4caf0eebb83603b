//! Columns in bins of much the same number of rows.

use rayon::prelude::*;

/// Columns in at most [`BINS`] bins: bin `k` holds values above edge `k − 1` and up to edge `k`.
#[derive(Debug, Clone)]
pub struct Binned {
    /// Increasing edges of every column.
    pub edges: Vec<Vec<f32>>,
    /// Bin of every row, a vector a column.
    pub bins: Vec<Vec<u8>>,
}

/// Most bins of a column.
pub(super) const BINS: usize = 64;
/// Rows from which the edges are taken, at most.
const ROWS: usize = 20_000;

impl Binned {
    /// Bins columns by their quantiles.
    pub fn new(values: &[Vec<f64>]) -> Self {
        let edges: Vec<Vec<f32>> = values.par_iter().map(|column| edges(column)).collect();
        let bins = values.par_iter().zip(&edges).map(|(column, edges)| binned(column, edges)).collect();
        Self { edges, bins }
    }

    /// Number of rows.
    pub(super) fn rows(&self) -> usize {
        self.bins.first().map_or(0, Vec::len)
    }
}

/// Edges between neighbouring values: midway where there are few, at quantiles where there are many.
fn edges(column: &[f64]) -> Vec<f32> {
    let stride = column.len().div_ceil(ROWS).max(1);
    let mut sorted: Vec<f64> = column.iter().copied().step_by(stride).collect();
    sorted.sort_by(f64::total_cmp);
    let mut distinct = sorted.clone();
    distinct.dedup();
    let mut edges: Vec<f32> = if distinct.len() <= BINS {
        distinct.windows(2).map(|w| (0.5 * (w[0] + w[1])) as f32).collect()
    } else {
        (1..BINS).map(|k| sorted[k * sorted.len() / BINS] as f32).collect()
    };
    edges.retain(|edge| edge.is_finite());
    edges.dedup();
    edges
}

fn binned(column: &[f64], edges: &[f32]) -> Vec<u8> {
    column.iter().map(|x| edges.partition_point(|edge| f64::from(*edge) < *x) as u8).collect()
}
