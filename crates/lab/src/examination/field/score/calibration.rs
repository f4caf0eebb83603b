//! Whether probabilities mean what they say, against what chance alone would make of probabilities that do.

use super::rating::Asked;
use crate::examination::{CalibrationBin, calibration_bins, calibration_error, uniform};

/// Claimed probabilities against what holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Claims {
    /// Bins of the probability, empty ones left out.
    pub bins: Vec<CalibrationBin>,
    /// Claims.
    pub count: usize,
    /// Expected calibration error.
    pub error: Option<f64>,
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
        Self { error: calibration_error(&bins), perfect: perfect(&claims), count: claims.len(), bins }
    }

    /// Calibration error over what perfect calibration would show.
    pub(crate) fn excess(&self) -> Option<f64> {
        Some(self.error? - self.perfect?)
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
#[derive(Debug, Clone, PartialEq)]
pub struct Stratum {
    /// Measured or made, and how the fault came in.
    pub of: String,
    /// Whether the base's model was given.
    pub with_model: bool,
    /// What was claimed.
    pub claims: Claims,
}

/// Every stratum, the one whose calibration is worst first.
pub(super) fn strata(asked: &[Asked<'_>]) -> Vec<Stratum> {
    let mut kinds: Vec<(String, bool)> = asked.iter().map(|a| (a.stratum(), a.answer.with_model)).collect();
    kinds.sort();
    kinds.dedup();
    let stratum = |(of, with_model): (String, bool)| {
        let inside = asked.iter().filter(|a| a.answer.with_model == with_model && a.stratum() == of);
        let claims = Claims::of(inside.filter_map(Asked::claim));
        Stratum { of, with_model, claims }
    };
    let mut strata: Vec<Stratum> = kinds.into_iter().map(stratum).filter(|s| s.claims.count > 0).collect();
    let excess = |s: &Stratum| s.claims.excess().unwrap_or(f64::NEG_INFINITY);
    strata.sort_by(|x, y| excess(y).total_cmp(&excess(x)));
    strata
}
