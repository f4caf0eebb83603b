//! Spectra of errors.

use std::f64::consts::PI;
use switchback_model::spectrum;

/// Squared magnitudes of the transform of a signal freed of its mean, with or without a Hann window, at frequencies `πk/n` for `k = 1…n`.
pub(super) fn power(x: &[f64], is_windowed: bool) -> Vec<f64> {
    let count = x.len().max(1);
    let mean = x.iter().sum::<f64>() / count as f64;
    let window = |t: usize| match is_windowed {
        true => 0.5 - 0.5 * libm::cos(2.0 * PI * t as f64 / count as f64),
        false => 1.0,
    };
    let centred: Vec<f64> = x.iter().enumerate().map(|(t, x)| (x - mean) * window(t)).collect();
    spectrum::power(&centred, 2 * count).split_off(1)
}

/// Means of the logarithm over a window of 41 lines.
pub(super) fn level(log_power: &[f64]) -> Vec<f64> {
    const HALF: usize = 20;
    let count = log_power.len();
    (0..count)
        .map(|k| {
            let part = &log_power[k.saturating_sub(HALF)..(k + HALF + 1).min(count)];
            part.iter().sum::<f64>() / part.len() as f64
        })
        .collect()
}

/// Longest piece that is transformed.
const LONGEST: usize = 8192;
/// Lines below this number are slow changes.
const FIRST: usize = 16;

/// The frequency, radians a sample, at which the longest record's error stands highest above its neighbours.
pub(super) fn strongest_line(errors: &[Vec<f64>]) -> Option<f64> {
    let longest = errors.iter().max_by_key(|e| e.len())?;
    let power = power(&longest[..longest.len().min(LONGEST)], true);
    if power.len() < 4 * FIRST {
        return None;
    }
    let logs: Vec<f64> = power.iter().map(|p| libm::log(p + f64::MIN_POSITIVE)).collect();
    let levels = level(&logs);
    let above = |k: &usize| logs[*k] - levels[*k];
    let k = (FIRST..power.len() - 1).max_by(|i, j| above(i).total_cmp(&above(j)))?;
    Some(PI * (k + 1) as f64 / power.len() as f64)
}
