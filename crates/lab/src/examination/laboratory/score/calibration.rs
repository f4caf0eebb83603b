//! Whether probabilities mean what they say.

use crate::blind::case::Case;
use crate::blind::design::Kind;
use crate::examination::{CalibrationBin, Share, calibration_bins, calibration_error};

/// Claimed probability of verdicts against how often they hold.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    /// Bins of the verdict's probability, empty ones left out.
    pub bins: Vec<CalibrationBin>,
    /// Expected calibration error of the verdict's probability: `Σ (n_bin/n)·|mean claimed − share held|`.
    pub ece: Option<f64>,
    /// The same for the likeliest candidate, `none` and `unexplained` among the candidate.
    pub top_ece: Option<f64>,
}

/// What an answer costs when verdicts below a probability are withheld.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AbstentionRow {
    /// The probability.
    pub threshold: f64,
    /// Verdicts still given.
    pub answered: Share,
    /// Of these, right ones.
    pub right: Share,
}

pub(super) fn calibration(cases: &[Case]) -> Calibration {
    let claims: Vec<(f64, bool)> = judged(cases).map(|c| (c.reply.probability, c.verdict_holds())).collect();
    let tops: Vec<(f64, bool)> = judged(cases).map(|c| (c.reply.top.1, c.top_is_true())).collect();
    let bins = calibration_bins(&claims);
    Calibration { ece: calibration_error(&bins), top_ece: calibration_error(&calibration_bins(&tops)), bins }
}

pub(super) fn abstention(cases: &[Case]) -> Vec<AbstentionRow> {
    [0.0, 0.3, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99]
        .into_iter()
        .map(|threshold| AbstentionRow {
            threshold,
            answered: Share::over(judged(cases), |c| c.reply.probability >= threshold),
            right: Share::over(
                judged(cases).filter(|c| c.reply.probability >= threshold),
                Case::verdict_holds,
            ),
        })
        .collect()
}

/// Rigs with one candidate at most; of pairs no single probability speaks.
fn judged(cases: &[Case]) -> impl Iterator<Item = &Case> {
    cases.iter().filter(|c| c.kind != Kind::Pair && c.reply.status != "failed")
}
