//! Signals that are computed from others, and so say nothing of their own: differences, factors, derivatives.

use nalgebra::{DMatrix, DVector};

/// Signals that one is compared with.
const COMPARED: usize = 12;
/// Share of its variance that a derivative may leave once it is summed up: what is measured has noise of its own.
const LEFT: f64 = 1e-3;

/// Whether a signal is a sum of one or two others by constant factors, as exactly as it was written, or the derivative of one.
pub(super) fn is_derived(signal: &[f64], others: &[&[f64]]) -> bool {
    let others = &others[..others.len().min(COMPARED)];
    let is_sum = |by: &[&[f64]]| is_sum(signal, by);
    let each = || others.iter().enumerate();
    each().any(|(_, other)| is_sum(&[other]) || is_derivative(signal, other))
        || each().any(|(k, first)| others[k + 1..].iter().any(|second| is_sum(&[first, second])))
}

/// Whether a signal is a constant and some others by factors, up to rounding.
fn is_sum(signal: &[f64], others: &[&[f64]]) -> bool {
    let rows: Vec<usize> = (0..signal.len())
        .filter(|&row| signal[row].is_finite() && others.iter().all(|other| other[row].is_finite()))
        .collect();
    let Some((factors, square)) = fit(signal, others, &rows) else { return false };
    // Each value is off by up to half its last digit, evenly.
    let rounding = |x: &[f64]| step(x).powi(2) / 12.0;
    let written: f64 =
        others.iter().zip(&factors).map(|(other, factor)| factor.powi(2) * rounding(other)).sum();
    square <= 2.0 * (written + rounding(signal))
}

/// The factors of the best fit without its constant, and the mean square that it leaves.
fn fit(signal: &[f64], others: &[&[f64]], rows: &[usize]) -> Option<(Vec<f64>, f64)> {
    if rows.len() < 10 * (others.len() + 1) {
        return None;
    }
    let count = rows.len() as f64;
    let centred = |x: &[f64]| {
        let mean = rows.iter().map(|row| x[*row]).sum::<f64>() / count;
        DVector::from_iterator(rows.len(), rows.iter().map(|row| x[*row] - mean))
    };
    let by: Vec<DVector<f64>> = others.iter().map(|other| centred(other)).collect();
    let wanted = centred(signal);
    let normal = DMatrix::from_fn(by.len(), by.len(), |a, b| by[a].dot(&by[b]));
    let factors = normal.cholesky()?.solve(&DVector::from_fn(by.len(), |a, _| by[a].dot(&wanted)));
    let left = by.iter().zip(factors.iter()).fold(wanted, |left, (by, factor)| left - by * *factor);
    Some((factors.iter().copied().collect(), left.norm_squared() / count))
}

/// The least step between two values: the last digit of what was written.
fn step(values: &[f64]) -> f64 {
    let steps = values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).filter(|step| *step > 0.0);
    let least = steps.fold(f64::INFINITY, f64::min);
    // Differences of numbers near each other are off by their last bits.
    let size = values.iter().filter(|x| x.is_finite()).fold(0.0, |size: f64, x| size.max(x.abs()));
    if least.is_finite() { least.max(1e-12 * size) } else { 0.0 }
}

/// Whether a signal, summed up, is another one but for a constant and a trend; each value may stand for the step before it, behind it, or both.
fn is_derivative(signal: &[f64], of: &[f64]) -> bool {
    let rows: Vec<usize> =
        (0..signal.len()).filter(|&row| signal[row].is_finite() && of[row].is_finite()).collect();
    let mut trend = vec![0.0; signal.len()];
    rows.iter().enumerate().for_each(|(k, row)| trend[*row] = k as f64);
    let spread = |by: &[&[f64]]| fit(of, by, &rows).map(|(_, left)| left);
    let Some(alone) = spread(&[&trend]) else { return false };
    [0.0, 0.5, 1.0].iter().any(|share| {
        let (mut sum, mut summed) = (0.0, vec![0.0; signal.len()]);
        for pair in rows.windows(2) {
            sum += (1.0 - share) * signal[pair[0]] + share * signal[pair[1]];
            summed[pair[1]] = sum;
        }
        spread(&[&trend, &summed]).is_some_and(|left| left < LEFT * alone)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A reference, a lag behind it, and their difference, as a logger prints them.
    fn loop_signals() -> [Vec<f64>; 3] {
        let printed = |x: f64| (x * 1e3).round() / 1e3;
        let reference: Vec<f64> = (0..800)
            .map(|k| 0.01 * f64::from(k))
            .map(|t| printed((5.1 * t).sin() * (0.9 * t).cos()))
            .collect();
        let mut y = 0.0;
        let follow = |x: &f64| {
            y += 0.2 * (x - y);
            y
        };
        let response: Vec<f64> = reference.iter().map(follow).map(printed).collect();
        let error = reference.iter().zip(&response).map(|(r, y)| printed(r - y)).collect();
        [reference, response, error]
    }

    #[test]
    fn differences_and_factors_are_derived() {
        let [reference, response, error] = loop_signals();
        assert!(is_derived(&error, &[&reference, &response]));
        let term: Vec<f64> = error.iter().map(|e| (0.1 * e * 1e4).round() / 1e4).collect();
        assert!(is_derived(&term, &[&error]));
        assert!(!is_derived(&response, &[&reference]));
        assert!(!is_derived(&error, &[&reference]));
    }

    #[test]
    fn derivatives_are_derived_and_what_lags_is_not() {
        let [reference, response, _] = loop_signals();
        let speed: Vec<f64> =
            (0..response.len()).map(|k| 100.0 * (response[k] - response[k.saturating_sub(1)])).collect();
        assert!(is_derived(&speed, &[&response]));
        assert!(!is_derived(&response, &[&speed]));
        assert!(!is_derived(&speed, &[&reference]));
    }
}
