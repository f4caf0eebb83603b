//! Score tests: what added columns would gain, without a re-fit.

use crate::least_squares::normal::{Factor, Normal};
use crate::likelihood::jacobian::Jacobian;
use switchback_model::sums::dot;

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
        small.gain() / self.variance
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

/// Columns that are all known before they are tested: sums over the samples show their gains, and no row of derivatives is kept.
pub(crate) struct Tested {
    /// Schur complement of the columns in their sums with the present parameters' derivatives.
    schur: Normal,
    corners: Vec<f64>,
    variance: f64,
}

impl Tested {
    /// From the [sums](crate::likelihood::jacobian::normal_equations) of `known` derivatives with the columns behind them, all weighted.
    pub(crate) fn of(sums: &Normal, known: usize, variance: f64) -> Option<Self> {
        let count = sums.size - known;
        let model = sums.leading(known);
        let factor = model.factor(1e-8)?;
        let left = factor.solve(&model.gradient);
        let cross = |j: usize| (0..known).map(|i| sums.entry(i, known + j)).collect::<Vec<f64>>();
        let crosses: Vec<Vec<f64>> = (0..count).map(cross).collect();
        let solved: Vec<Vec<f64>> = crosses.iter().map(|cross| factor.solve(cross)).collect();
        let mut schur = Normal::new(count);
        for i in 0..count {
            schur.gradient[i] = sums.gradient[known + i] - dot(&crosses[i], &left);
            for j in i..count {
                schur.set(i, j, sums.entry(known + i, known + j) - dot(&crosses[i], &solved[j]));
            }
        }
        let corners = (0..count).map(|j| sums.entry(known + j, known + j)).collect();
        Some(Self { schur, corners, variance })
    }

    /// As [`Gains::of`].
    pub(crate) fn gain(&self, columns: &[usize]) -> f64 {
        let mut small = Normal::new(columns.len());
        for (i, &c) in columns.iter().enumerate() {
            small.gradient[i] = self.schur.gradient[c];
            for (j, &d) in columns.iter().enumerate().skip(i) {
                let s = self.schur.entry(c, d);
                small.set(i, j, if i == j { s.max(1e-9 * self.corners[c]) } else { s });
            }
        }
        small.gain() / self.variance
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::likelihood::engine::{FitContext, fit};
    use crate::likelihood::jacobian::normal_equations;
    use crate::likelihood::weights::Weights;
    use crate::model::augmented::AugmentedModel;
    use crate::testing::{small_dataset, small_model, white};

    /// The oracle: columns tested one by one, with all derivatives kept.
    #[test]
    fn sums_alone_describe_what_columns_gain() {
        let (dataset, grid) = small_dataset();
        let context = FitContext { dataset: &dataset, grid: &grid, known: None };
        let mut augmented = AugmentedModel::default();
        for ma in [Vec::new(), vec![0.4]] {
            augmented.noise.ma = ma;
            let fit = fit(context, &|_| augmented.clone(), &[], &small_model(&grid), 4).expect("a fit");
            let (design, weights) = (fit.design(), Weights::default());
            let whitener = design.whitener(&augmented.noise, &fit.linear.a);
            let w = design.innovations(&fit.linear, &whitener).concat();
            let mut noise = white();
            let columns: Vec<Vec<f64>> = (0..3).map(|_| w.iter().map(|_| noise()).collect()).collect();
            let jacobian = Jacobian::new(&design, &fit.linear, &whitener, &weights);
            let gains = Gains::new(&jacobian, &w, fit.variance).expect("determined");
            let scored: Vec<Scored> = columns.iter().map(|column| gains.score(column.clone())).collect();
            let sums = normal_equations(&design, &fit.linear, &whitener, &weights, (&w, &columns));
            let tested = Tested::of(&sums, fit.linear.len(), fit.variance).expect("determined");
            for chosen in [vec![0], vec![1, 2], vec![0, 1, 2]] {
                let expected = gains.of(&chosen.iter().map(|&j| &scored[j]).collect::<Vec<_>>());
                let found = tested.gain(&chosen);
                assert!((found - expected).abs() < 1e-6 * expected, "{found} {expected}");
            }
        }
    }

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
