//! Which of two signals follows the other, where no name says so.

use nalgebra::{DMatrix, DVector};

/// Samples looked at: enough to see a hundred reversals of most machines.
pub(super) const LOOKED_AT: usize = 6000;
/// Samples of the past that predict the next one.
const LAGS: usize = 6;

/// By how much the past of each of two signals improves the prediction of the other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Precedence {
    /// Logarithm of the ratio of squared errors that `a` improves those of `b` by.
    pub(super) forward: f64,
    /// The same the other way round.
    pub(super) backward: f64,
}

/// The improvement by which a signal follows another beyond doubt, of this many rows: without any relation the rows times the improvement are
/// distributed as χ² with [`LAGS`] degrees of freedom, which exceeds 40 in one of two million.
pub(super) fn significant(rows: usize) -> f64 {
    (40.0 / rows.max(1) as f64).max(0.03)
}

impl Precedence {
    /// Granger's comparison: a signal is predicted from its own past, then from the other's too. A machine's output follows its input, and
    /// says nothing of what comes next there.
    ///
    /// None where the signals are too short.
    pub(super) fn of(a: &[f64], b: &[f64]) -> Option<Self> {
        let len = a.len().min(b.len()).min(LOOKED_AT);
        let past = 1..LAGS + 1;
        let sums = Sums::of(&[scaled(&a[..len]), scaled(&b[..len])], past.end)?;
        let improvement = |of: usize, by: usize| {
            let alone = sums.error(of, &[(of, past.clone())])?;
            let both = sums.error(of, &[(of, past.clone()), (by, past.clone())])?;
            Some((alone / both).ln().max(0.0))
        };
        Some(Self { forward: improvement(1, 0)?, backward: improvement(0, 1)? })
    }

    /// Whether `b` follows `a`.
    pub(super) fn is_forward(&self) -> bool {
        self.forward >= self.backward
    }
}

/// Samples ahead that an output is predicted, where inputs are compared: its own past must not explain all.
const AHEAD: usize = 5;

/// The squared error of the best linear prediction of an output some samples ahead, its input up to then being known.
pub(super) fn error_with(output: &[f64], input: &[f64]) -> Option<f64> {
    let len = output.len().min(input.len()).min(LOOKED_AT);
    let (output, input) = (&output[..len], &input[..len]);
    let lags = [(0, AHEAD..AHEAD + LAGS), (1, 0..AHEAD + LAGS)];
    Sums::of(&[scaled(output), scaled(input)], AHEAD + LAGS)?.error(0, &lags)
}

/// The share of its variance below which nothing of a signal can be predicted: what was printed is rounded.
const FLOOR: f64 = 1e-12;

/// Sums of products of signals at all their lags, over the rows from the longest lag on.
struct Sums {
    rows: usize,
    /// Of two signals at two lags.
    products: Vec<Vec<DMatrix<f64>>>,
    /// Of a signal at a lag.
    plain: Vec<Vec<f64>>,
}

impl Sums {
    /// One lag further on both sides only moves the ends of a sum, so the sums of one lag against all suffice.
    ///
    /// None where the signals are too short.
    fn of(signals: &[Vec<f64>], longest: usize) -> Option<Self> {
        let lags = longest + 1;
        let len = signals[0].len();
        let rows = len.checked_sub(longest)?;
        let at = |x: &[f64], row: usize, lag: usize| x[row - lag];
        let full = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let grid = |a: &[f64], b: &[f64]| {
            let mut grid = DMatrix::zeros(lags, lags);
            for lag in 0..lags {
                grid[(0, lag)] = full(&a[longest..], &b[longest - lag..len - lag]);
                grid[(lag, 0)] = full(&a[longest - lag..len - lag], &b[longest..]);
            }
            for i in 1..lags {
                for j in 1..lags {
                    let gained = at(a, longest, i) * at(b, longest, j);
                    let lost = at(a, len, i) * at(b, len, j);
                    grid[(i, j)] = grid[(i - 1, j - 1)] + gained - lost;
                }
            }
            grid
        };
        let row = |a: &Vec<f64>| signals.iter().map(|b| grid(a, b)).collect();
        let plain = |x: &Vec<f64>| (0..lags).map(|lag| x[longest - lag..len - lag].iter().sum()).collect();
        let products = signals.iter().map(row).collect();
        Some(Self { rows, products, plain: signals.iter().map(plain).collect() })
    }

    /// The squared error that the best linear prediction of a signal by some at some lags leaves; none where there are too few rows.
    fn error(&self, target: usize, by: &[(usize, std::ops::Range<usize>)]) -> Option<f64> {
        let regressors: Vec<(usize, usize)> =
            by.iter().flat_map(|(signal, lags)| lags.clone().map(move |lag| (*signal, lag))).collect();
        let width = 1 + regressors.len();
        if self.rows < 3 * width {
            return None;
        }
        let of = |k: usize| k.checked_sub(1).map(|k| regressors[k]);
        let (rows, now) = (self.rows as f64, Some((target, 0)));
        let normal = DMatrix::from_fn(width, width, |a, b| self.product(of(a), of(b)));
        let wanted = DVector::from_fn(width, |a, _| self.product(of(a), now));
        // A trifle of ridge keeps signals that repeat themselves from making the equations singular.
        let ridge = DMatrix::identity(width, width) * (1e-9 * rows);
        let solution = (&normal + ridge).cholesky()?.solve(&wanted);
        let explained = 2.0 * solution.dot(&wanted) - solution.dot(&(&normal * &solution));
        Some((self.product(now, now) - explained).max(FLOOR * rows))
    }

    /// Of two signals at their lags; none is the constant.
    fn product(&self, a: Option<(usize, usize)>, b: Option<(usize, usize)>) -> f64 {
        match (a, b) {
            (None, None) => self.rows as f64,
            (Some((signal, lag)), None) | (None, Some((signal, lag))) => self.plain[signal][lag],
            (Some((a, i)), Some((b, j))) => self.products[a][b][(i, j)],
        }
    }
}

/// A signal without its mean, in units of its standard deviation.
fn scaled(signal: &[f64]) -> Vec<f64> {
    let mean = signal.iter().sum::<f64>() / signal.len() as f64;
    let variance = signal.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / signal.len() as f64;
    let unit = variance.sqrt().max(f64::MIN_POSITIVE);
    signal.iter().map(|x| (x - mean) / unit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_output_of_a_lag_follows_its_input() {
        let input: Vec<f64> = (0..2000)
            .map(|k| 0.01 * f64::from(k))
            .map(|t| (5.1 * t).sin() * (0.9 * t).cos() + 0.3 * (13.0 * t).sin())
            .collect();
        let (mut y, mut state) = (0.0, 1_u64);
        let output: Vec<f64> = (0..2000_usize)
            .map(|k| {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                let noise = (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5;
                y += 0.4 * (input[k.saturating_sub(1)] - y) + 0.02 * noise;
                y
            })
            .collect();
        assert!(Precedence::of(&input, &output).unwrap().is_forward());
        assert!(!Precedence::of(&output, &input).unwrap().is_forward());
        assert_eq!(Precedence::of(&input[..10], &output[..10]), None);
    }
}
