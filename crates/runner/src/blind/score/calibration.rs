//! Whether probabilities mean what they say.

use super::Share;
use crate::blind::case::Case;
use crate::blind::design::Kind;

/// Claimed probability of verdicts against how often they hold.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    /// Bins of the verdict's probability, empty ones left out.
    pub bins: Vec<CalibrationBin>,
    /// Expected calibration error of the verdict's probability: `Σ (n_bin/n)·|mean claimed − share held|`.
    pub ece: Option<f64>,
    /// The same for the likeliest explanation, `none` and `unexplained` among the explanations.
    pub top_ece: Option<f64>,
}

/// Verdicts of similar probability.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CalibrationBin {
    /// Mean probability claimed.
    pub claimed: f64,
    /// Share of verdicts that hold.
    pub held: Share,
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

const BINS: usize = 10;

pub(super) fn calibration(cases: &[Case]) -> Calibration {
    let claims: Vec<(f64, bool)> = judged(cases).map(|c| (c.reply.probability, c.verdict_holds())).collect();
    let tops: Vec<(f64, bool)> = judged(cases).map(|c| (c.reply.top.1, c.top_is_true())).collect();
    let bins = bins(&claims);
    Calibration { ece: ece(&bins), top_ece: ece(&self::bins(&tops)), bins }
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

/// Rigs with one explanation at most; of pairs no single probability speaks.
fn judged(cases: &[Case]) -> impl Iterator<Item = &Case> {
    cases.iter().filter(|c| c.kind != Kind::Pair && c.reply.status != "failed")
}

fn bins(claims: &[(f64, bool)]) -> Vec<CalibrationBin> {
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

fn ece(bins: &[CalibrationBin]) -> Option<f64> {
    let all: usize = bins.iter().map(|b| b.held.of).sum();
    let miss = |b: &CalibrationBin| b.held.of as f64 * (b.claimed - b.held.value().unwrap_or(0.0)).abs();
    (all > 0).then(|| bins.iter().map(miss).sum::<f64>() / all as f64)
}
