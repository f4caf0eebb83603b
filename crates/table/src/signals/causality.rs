//! Which of two signals follows the other, where no name says so.

use nalgebra::{DMatrix, DVector};

/// Samples looked at: enough to see a hundred reversals of most machines.
const LOOKED_AT: usize = 6000;
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

impl Precedence {
    /// Granger's comparison: a signal is predicted from its own past, then from the other's too. A machine's output follows its input, and
    /// says nothing of what comes next there.
    ///
    /// None where the signals are too short.
    pub(super) fn of(a: &[f64], b: &[f64]) -> Option<Self> {
        let len = a.len().min(b.len()).min(LOOKED_AT);
        let (a, b) = (&a[..len], &b[..len]);
        Some(Self { forward: improvement(a, b)?, backward: improvement(b, a)? })
    }

    /// Whether `b` follows `a`.
    pub(super) fn is_forward(&self) -> bool {
        self.forward >= self.backward
    }
}

/// How much the past of `by` improves the prediction of `of`.
fn improvement(by: &[f64], of: &[f64]) -> Option<f64> {
    let past = 1..LAGS + 1;
    let alone = error(of, (of, past.clone()), None)?;
    let both = error(of, (of, past.clone()), Some((by, past)))?;
    Some((alone / both).ln().max(0.0))
}

/// Samples ahead that an output is predicted, where inputs are compared: its own past must not explain all.
const AHEAD: usize = 5;

/// The squared error of the best linear prediction of an output some samples ahead, its input up to then being known.
pub(super) fn error_with(output: &[f64], input: &[f64]) -> Option<f64> {
    let len = output.len().min(input.len()).min(LOOKED_AT);
    let (output, input) = (&output[..len], &input[..len]);
    error(output, (output, AHEAD..AHEAD + LAGS), Some((input, 0..AHEAD + LAGS)))
}

/// A signal and the lags at which it is taken.
type Past<'a> = (&'a [f64], std::ops::Range<usize>);

fn error(target: &[f64], (own, own_lags): Past<'_>, other: Option<Past<'_>>) -> Option<f64> {
    let first = own_lags.end.max(other.as_ref().map_or(0, |(_, lags)| lags.end));
    let rows = target.len().checked_sub(first)?;
    let mut signals: Vec<(Vec<f64>, usize)> = Vec::new();
    signals.extend(own_lags.map(|lag| (scaled(own), lag)));
    signals.extend(other.into_iter().flat_map(|(other, lags)| lags.map(move |lag| (scaled(other), lag))));
    let width = 1 + signals.len();
    if rows < 3 * width {
        return None;
    }
    let regressor = |row: usize, column: usize| match column.checked_sub(1) {
        None => 1.0,
        Some(k) => signals[k].0[row + first - signals[k].1],
    };
    let target = scaled(target);
    let design = DMatrix::from_fn(rows, width, regressor);
    let wanted = DVector::from_fn(rows, |row, _| target[row + first]);
    // A trifle of ridge keeps signals that repeat themselves from making the equations singular.
    let normal = design.tr_mul(&design) + DMatrix::identity(width, width) * (1e-9 * rows as f64);
    let solution = normal.cholesky()?.solve(&design.tr_mul(&wanted));
    let left = (wanted - design * solution).norm_squared();
    Some(left.max(1e-12 * rows as f64))
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
