//! Whether probabilities mean what they say.

use super::measure::Share;

/// Verdicts of similar probability.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CalibrationBin {
    /// Mean probability claimed.
    pub claimed: f64,
    /// Share of verdicts that hold.
    pub held: Share,
}

const BINS: usize = 10;

/// Claims with whether they hold, in ten bins of equal width; empty ones are left out.
pub(crate) fn calibration_bins(claims: &[(f64, bool)]) -> Vec<CalibrationBin> {
    (0..BINS)
        .filter_map(|k| {
            let inside: Vec<_> =
                claims.iter().filter(|(p, _)| ((p * BINS as f64) as usize).min(BINS - 1) == k).collect();
            let of = inside.len();
            let claimed = inside.iter().map(|(p, _)| p).sum::<f64>() / of as f64;
            let count = inside.iter().filter(|(_, held)| *held).count();
            (of > 0).then_some(CalibrationBin { claimed, held: Share { count, of } })
        })
        .collect()
}

/// Expected calibration error, `Σ (n_bin/n)·|mean claimed − share held|`; none of nothing.
pub(crate) fn calibration_error(bins: &[CalibrationBin]) -> Option<f64> {
    let all: usize = bins.iter().map(|b| b.held.of).sum();
    let miss = |b: &CalibrationBin| b.held.of as f64 * (b.claimed - b.held.value().unwrap_or(0.0)).abs();
    (all > 0).then(|| bins.iter().map(miss).sum::<f64>() / all as f64)
}
