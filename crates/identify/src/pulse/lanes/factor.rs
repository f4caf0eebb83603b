//! Small triangular systems of eight replicates.

use switchback_noise::lanes::{LANES, Lane};

/// A replicate whose pivot keeps less than this share of its diagonal entry is left to the solver that goes one by one.
pub(super) const SOUND: f64 = 1e-12;

/// Cholesky's lower triangle, the inverse pivots on the diagonal.
///
/// Loops over a triangle run over the square and skip the rest: those bounds the compiler knows, so that it unrolls them into registers.
#[derive(Clone, Copy)]
pub(super) struct Factor<const D: usize>([[Lane; D]; D]);

impl<const D: usize> Factor<D> {
    /// Factors a matrix given by its lower triangle; says which replicates kept their digits.
    #[inline(always)]
    pub(super) fn new(matrix: &[[Lane; D]; D]) -> (Self, [bool; LANES]) {
        let mut factor = [[Lane::ZERO; D]; D];
        let mut sound = [true; LANES];
        for j in 0..D {
            let before = matrix[j][j];
            let mut pivot = before;
            for k in 0..D {
                if k < j {
                    pivot -= factor[j][k] * factor[j][k];
                }
            }
            for l in 0..LANES {
                sound[l] &= pivot.0[l] > SOUND * before.0[l];
            }
            let inverse = Lane::splat(1.0) / pivot.sqrt();
            factor[j][j] = inverse;
            for i in 0..D {
                if i > j {
                    let mut x = matrix[i][j];
                    for k in 0..D {
                        if k < j {
                            x -= factor[i][k] * factor[j][k];
                        }
                    }
                    factor[i][j] = x * inverse;
                }
            }
        }
        (Self(factor), sound)
    }

    /// `L⁻¹x`.
    #[inline(always)]
    pub(super) fn forward(&self, x: &[Lane; D]) -> [Lane; D] {
        let mut solved = [Lane::ZERO; D];
        for i in 0..D {
            let mut value = x[i];
            for k in 0..D {
                if k < i {
                    value -= self.0[i][k] * solved[k];
                }
            }
            solved[i] = value * self.0[i][i];
        }
        solved
    }

    /// `(LLᵀ)⁻¹x`.
    #[inline(always)]
    pub(super) fn solve(&self, x: &[Lane; D]) -> [Lane; D] {
        let mut x = self.forward(x);
        for back in 1..D + 1 {
            let i = D - back;
            let mut value = x[i];
            for k in 0..D {
                if k > i {
                    value -= self.0[k][i] * x[k];
                }
            }
            x[i] = value * self.0[i][i];
        }
        x
    }

    /// The diagonal of `(LLᵀ)⁻¹`.
    #[inline(always)]
    pub(super) fn inverse_diagonal(&self) -> [Lane; D] {
        let mut diagonal = [Lane::ZERO; D];
        for j in 0..D {
            // Column j of L⁻¹.
            let mut column = [Lane::ZERO; D];
            column[j] = self.0[j][j];
            diagonal[j] = column[j] * column[j];
            for i in 0..D {
                if i > j {
                    let mut value = Lane::ZERO;
                    for k in 0..D {
                        if k >= j && k < i {
                            value -= self.0[i][k] * column[k];
                        }
                    }
                    column[i] = value * self.0[i][i];
                    diagonal[j] += column[i] * column[i];
                }
            }
        }
        diagonal
    }
}

/// `Σ xᵢyᵢ`, over the shorter of the two, which has at least one entry.
#[inline(always)]
pub(super) fn dot(x: &[Lane], y: &[Lane]) -> Lane {
    let mut sum = x[0] * y[0];
    for (x, y) in x[1..].iter().zip(&y[1..]) {
        sum += *x * *y;
    }
    sum
}
