//! Whether probabilities mean what they say, against what chance alone would make of probabilities that do.

use super::random::uniform;
use super::share::Share;
use serde::{Deserialize, Serialize};

/// Verdicts of similar probability.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
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

/// Claimed probabilities against what holds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Claims {
    /// Bins of the probability, empty ones left out.
    pub bins: Vec<CalibrationBin>,
    /// Claims.
    #[serde(rename = "claims")]
    pub count: usize,
    /// Expected calibration error.
    pub error: Option<f64>,
    /// Calibration error over what perfect calibration would show.
    pub excess: Option<f64>,
    /// What claims of the same probabilities would show on average, were each to hold with the probability it claims.
    pub perfect: Option<f64>,
}

/// Simulations of perfect calibration: the mean is known to a thousandth where a hundred claims are made.
const DRAWS: u64 = 400;
/// Their seed: the result is a function of the claims.
const SEED: u64 = 0x4341_4C49_4252;

impl Claims {
    /// Counts them.
    pub(crate) fn of(claims: impl Iterator<Item = (f64, bool)>) -> Self {
        let claims: Vec<(f64, bool)> = claims.collect();
        let bins = calibration_bins(&claims);
        let (error, perfect) = (calibration_error(&bins), perfect(&claims));
        let excess = error.zip(perfect).map(|(error, perfect)| error - perfect);
        Self { bins, count: claims.len(), error, excess, perfect }
    }
}

fn perfect(claims: &[(f64, bool)]) -> Option<f64> {
    let count = claims.len() as u64;
    let errors = (0..DRAWS).map(|draw| {
        let drawn = |(k, (p, _)): (usize, &(f64, bool))| (*p, uniform(SEED, draw * count + k as u64) < *p);
        let drawn: Vec<(f64, bool)> = claims.iter().enumerate().map(drawn).collect();
        calibration_error(&calibration_bins(&drawn))
    });
    Some(errors.sum::<Option<f64>>()? / DRAWS as f64)
}

/// The claims about rigs of one kind.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stratum {
    /// Measured or made, and how the fault came in.
    pub of: String,
    /// Whether the base's model was given.
    pub with_model: bool,
    /// What was claimed.
    #[serde(rename = "calibration")]
    pub claims: Claims,
}
