//! The over-parameterised regression: one coefficient for every product `bᵢ f_k`.

use super::problem::{Segment, Structure};
use nalgebra::DMatrix;

/// Moments of the regression
///
/// ```text
/// y(t) = −Σᵢ aᵢ y(t−i) + Σᵢₖ μᵢₖ φₖ(t−d−i) + c + ξ(t)
/// ```
///
/// in the order `a` (n), `μ` (lag by lag, m features each), `c`, and last `y` itself. A row has `n + 2·n_b + 2` non-zeros whatever the number of
/// knots, so a sample costs `O((n + n_b)²)`.
#[derive(Debug, Clone)]
pub struct Moments {
    pub(super) structure: Structure,
    /// Features of the basis.
    pub(super) width: usize,
    /// `Σ row·rowᵀ`; symmetric, both halves filled.
    pub(super) matrix: DMatrix<f64>,
    /// Rows summed.
    pub(super) samples: usize,
}

impl Moments {
    /// Sums over stretches of data.
    pub(super) fn of(structure: Structure, width: usize, segments: &[Segment]) -> Self {
        let size = structure.order + structure.numerator() * width + 2;
        let mut matrix = DMatrix::zeros(size, size);
        let mut row = Vec::with_capacity(3 * structure.order + 5);
        for segment in segments {
            for t in segment.from..segment.to {
                fill_row(structure, width, segment, t, &mut row);
                for (i, &(p, x)) in row.iter().enumerate() {
                    for &(q, z) in &row[..=i] {
                        matrix[(p.max(q), p.min(q))] += x * z;
                    }
                }
            }
        }
        matrix.fill_upper_triangle_with_lower_triangle();
        Self { structure, width, matrix, samples: segments.iter().map(Segment::len).sum() }
    }

    /// Column of the constant; the output's column follows it.
    pub(super) fn constant(&self) -> usize {
        self.matrix.nrows() - 2
    }

    /// Column of `μᵢₖ`, both from 0.
    pub(super) fn product(&self, i: usize, k: usize) -> usize {
        self.structure.order + i * self.width + k
    }
}

/// One row of the regression as (column, value).
pub(super) fn fill_row(
    structure: Structure,
    width: usize,
    segment: &Segment,
    t: usize,
    row: &mut Vec<(usize, f64)>,
) {
    let n = structure.order;
    row.clear();
    row.extend((0..n).map(|i| (i, -segment.y[t - 1 - i])));
    for i in 0..structure.numerator() {
        let cell = segment.cells.at(structure.input(t, i));
        row.extend(cell.features().map(|(k, x)| (n + i * width + k, x)));
    }
    let constant = n + structure.numerator() * width;
    row.push((constant, 1.0));
    row.push((constant + 1, segment.y[t]));
}
