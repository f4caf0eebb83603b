//! Score tests: what added columns would gain, without a re-fit.

use crate::least_squares::normal::{Factor, Normal};
use crate::least_squares::sums::dot;
use crate::likelihood::jacobian::Jacobian;

/// A model at its fit, to which columns may be added.
pub(crate) struct Gains<'a> {
    jacobian: &'a Jacobian,
    /// Weighted innovations.
    w: &'a [f64],
    variance: f64,
    factor: Factor,
    /// `(XᵀX)⁻¹Xᵀw`: zero but for rounding where the fit has converged.
    left: Vec<f64>,
}

/// A column with what it shares with the present parameters.
pub(crate) struct Scored {
    /// From its first number that is not zero to the last.
    column: Vec<f64>,
    first: usize,
    cross: Vec<f64>,
    solved: Vec<f64>,
    gradient: f64,
}

impl Scored {
    /// `Σ x·y` of two columns.
    fn dot(&self, other: &Self) -> f64 {
        let first = self.first.max(other.first);
        let rest = |c: &'_ Self| first.saturating_sub(c.first).min(c.column.len());
        dot(&self.column[rest(self)..], &other.column[rest(other)..])
    }
}

/// What a column shares with the model.
#[derive(Debug, Clone)]
pub(crate) struct Sums {
    /// With the derivatives.
    pub(crate) cross: Vec<f64>,
    /// With the innovations.
    pub(crate) plain: f64,
    /// With itself.
    pub(crate) corner: f64,
}

impl<'a> Gains<'a> {
    /// The present parameters' derivatives and the innovations, both weighted.
    pub(crate) fn new(jacobian: &'a Jacobian, w: &'a [f64], variance: f64) -> Option<Self> {
        let normal = jacobian.normal(w);
        let factor = normal.factor(1e-8)?;
        let left = factor.solve(&normal.gradient);
        Some(Self { jacobian, w, variance, factor, left })
    }

    /// Prepares a weighted column.
    pub(crate) fn score(&self, mut column: Vec<f64>) -> Scored {
        let first = column.iter().position(|x| *x != 0.0).unwrap_or(column.len());
        column.truncate(column.iter().rposition(|x| *x != 0.0).map_or(first, |last| last + 1));
        column.drain(..first);
        let cross = self.jacobian.cross(first, &column);
        let solved = self.factor.solve(&cross);
        let gradient = dot(&column, &self.w[first..]) - dot(&cross, &self.left);
        Scored { column, first, cross, solved, gradient }
    }

    /// Approximate gain in deviance from adding these columns, `gᵀ S⁻¹ g / σ²` with `S` the Schur complement.
    pub(crate) fn of(&self, columns: &[&Scored]) -> f64 {
        let mut small = Normal::new(columns.len());
        for (i, c) in columns.iter().enumerate() {
            small.gradient[i] = c.gradient;
            for (j, d) in columns.iter().enumerate().skip(i) {
                let corner = c.dot(d);
                let s = corner - dot(&c.cross, &d.solved);
                small.set(i, j, if i == j { s.max(1e-9 * corner) } else { s });
            }
        }
        let Some(factor) = small.factor(1e-9) else { return 0.0 };
        let x = factor.solve(&small.gradient);
        x.iter().zip(&small.gradient).map(|(x, g)| x * g).sum::<f64>() / self.variance
    }

    /// Sums of a column of zeros.
    pub(crate) fn no_sums(&self) -> Sums {
        Sums { cross: vec![0.0; self.left.len()], plain: 0.0, corner: 0.0 }
    }

    /// Adds `x` at a row of a column to what the column shares with the model.
    pub(crate) fn add_to(&self, sums: &mut Sums, row: usize, x: f64) {
        sums.plain += x * self.w[row];
        self.jacobian.add_row(row, x, &mut sums.cross);
    }

    /// Approximate gain in deviance from adding one column.
    pub(crate) fn of_sums(&self, sums: &Sums) -> f64 {
        let schur = sums.corner - self.factor.energy(&sums.cross);
        let gradient = sums.plain - dot(&sums.cross, &self.left);
        let least = 1e-9 * sums.corner;
        if schur.max(least) > 0.0 { gradient * gradient / schur.max(least) / self.variance } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn columns_share_only_where_both_are_something(
            x in prop::collection::vec(-3..4_i32, 0..20),
            y in prop::collection::vec(-3..4_i32, 0..20),
            (first, other) in (0..30_usize, 0..30_usize),
        ) {
            let scored = |first: usize, column: &[i32]| Scored {
                column: column.iter().map(|x| f64::from(*x)).collect(),
                first,
                cross: Vec::new(),
                solved: Vec::new(),
                gradient: 0.0,
            };
            let whole = |first: usize, column: &[i32]| {
                let mut whole = [0; 60];
                whole[first..first + column.len()].copy_from_slice(column);
                whole
            };
            let slow: i32 = whole(first, &x).iter().zip(whole(other, &y)).map(|(x, y)| x * y).sum();
            prop_assert_eq!(scored(first, &x).dot(&scored(other, &y)), f64::from(slow));
        }
    }
}
