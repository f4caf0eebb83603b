//! Output units: identification works on a centred output of unit size, and its answer is reported in the units of the records.

use super::problem::Parameters;
use nalgebra::DMatrix;
use switchback_model::record::Record;

/// Where the scale that the identification works on has its zero and its one, output units.
///
/// With `y = origin + scale·y′` the same system reads
///
/// ```text
/// A(q⁻¹) y′(t) = Σᵢ bᵢ u(t−d−i) + c           on the centred output
/// A(q⁻¹) y(t)  = Σᵢ s·bᵢ u(t−d−i) + s·c + origin·A(1),   s = scale
/// ```
///
/// Normal equations square the output: an origin of 10⁵ spreads costs ten of the sixteen digits of what they report `A`. On the centred output the
/// answer depends on neither origin nor scale, but for the rounding of the records themselves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct OutputUnits {
    pub(super) origin: f64,
    /// Positive.
    pub(super) scale: f64,
}

impl OutputUnits {
    /// Those of a fit to the records as they are.
    pub(super) const OWN: Self = Self { origin: 0.0, scale: 1.0 };

    /// The middle of the outputs and half of their range, so that centred ones lie between −1 and 1; differences alone where the output is
    /// constant.
    pub(super) fn of(records: &[&Record]) -> Self {
        let outputs = records.iter().flat_map(|record| record.y());
        let (low, high) =
            outputs.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &y| (low.min(y), high.max(y)));
        // Halved before they are added: the range of finite numbers need not be finite.
        let half = 0.5 * high - 0.5 * low;
        Self { origin: 0.5 * low + 0.5 * high, scale: if half > 0.0 { half } else { 1.0 } }
    }

    /// The record with its output centred and of unit size.
    pub(super) fn centred(self, record: &Record) -> Record {
        let y = record.y().iter().map(|y| (y - self.origin) / self.scale).collect();
        Record::new(record.v().to_vec(), y).unwrap_or_else(|_| record.clone())
    }

    /// The origin in units of the scale.
    pub(super) fn relative_origin(self) -> f64 {
        self.origin / self.scale
    }

    /// A level of the centred output, output units.
    pub(super) fn level(self, centred: f64) -> f64 {
        self.origin + self.scale * centred
    }

    /// The system that gives the output itself.
    pub(super) fn parameters(self, centred: &Parameters) -> Parameters {
        let Parameters { a, b, f, c } = centred;
        let a_one = 1.0 + a.iter().sum::<f64>();
        let b = b.iter().map(|b| self.scale * b).collect();
        Parameters { a: a.clone(), b, f: f.clone(), c: self.scale * c + self.origin * a_one }
    }

    /// The covariance of [`Self::parameters`] from that of the centred ones: `J C Jᵀ`, row by row, with `J` the derivative of the former in the
    /// latter.
    pub(super) fn covariance(self, theta: &Parameters, centred: DMatrix<f64>) -> Vec<Vec<f64>> {
        let (n, nb) = (theta.a.len(), theta.b.len());
        let mut covariance = centred;
        let last = covariance.nrows() - 1;
        let transform = |matrix: &mut DMatrix<f64>| {
            for mut column in matrix.column_iter_mut() {
                let of_a: f64 = column.rows(0, n).sum();
                column.rows_mut(n, nb).scale_mut(self.scale);
                column[last] = self.scale * column[last] + self.origin * of_a;
            }
        };
        transform(&mut covariance);
        covariance.transpose_mut();
        transform(&mut covariance);
        covariance.row_iter().map(|row| row.iter().copied().collect()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_covariance_goes_by_the_derivative_of_the_parameters() {
        let theta = Parameters { a: vec![-1.2, 0.4], b: vec![0.3], f: vec![0.5, 1.0], c: 0.2 };
        let units = OutputUnits { origin: 7.0, scale: 3.0 };
        let centred = DMatrix::from_fn(6, 6, |i, j| 1.0 / (1.0 + i as f64 + j as f64));
        let flat = |p: &Parameters| [p.a.clone(), p.b.clone(), p.f.clone(), vec![p.c]].concat();
        let here = flat(&units.parameters(&theta));
        // The parameters are linear in the centred ones: a step of one gives the derivative.
        let derivative = DMatrix::from_fn(6, 6, |i, j| {
            let step: Vec<f64> = (0..6).map(|k| f64::from(u8::from(k == j))).collect();
            flat(&units.parameters(&theta.moved(&step)))[i] - here[i]
        });
        let expected = &derivative * &centred * derivative.transpose();
        let found = units.covariance(&theta, centred);
        for (i, row) in found.iter().enumerate() {
            for (j, x) in row.iter().enumerate() {
                assert!((x - expected[(i, j)]).abs() < 1e-12 * expected.amax(), "{i} {j}");
            }
        }
    }

    #[test]
    fn the_whole_range_of_numbers_can_be_centred() {
        let record = Record::new(vec![0.0, 1.0, 2.0], vec![f64::MAX, 0.0, -f64::MAX]).unwrap();
        let units = OutputUnits::of(&[&record]);
        assert_eq!(units.centred(&record).y(), [1.0, 0.0, -1.0]);
    }
}
