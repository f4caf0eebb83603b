//! From fitted explanations to a verdict with calibrated probabilities.

use crate::diagnosis::{Status, Verdict};
use crate::effect::Effect;
use crate::explain::Explanation;
use crate::omnibus::Omnibus;
use crate::settings::Settings;

/// Penalised deviance that an effect must gain before anything is missing at all: covers the search over twenty effects,
/// their laws and their own parameters.
pub(crate) const SIGNIFICANT: f64 = 40.0;

/// Deviance left in general that is still no gap worth a verdict: on ten thousand samples, a tenth of the noise's
/// standard deviation.
const IMMATERIAL: f64 = 100.0;

/// Probabilities of the explanations, of none and of none of these.
#[derive(Debug, Clone)]
pub(crate) struct Odds {
    /// One per explanation, in the order given.
    pub(crate) effects: Vec<f64>,
    pub(crate) none: f64,
    pub(crate) unexplained: f64,
}

/// Calibration constants, found on simulated rigs with known causes (`examples/self_score.rs`).
mod calibration {
    /// Share of what the best explanation leaves that counts against the distance to its rivals: laws are never exact, so
    /// a rival is ruled out only by a distance large against what the best itself leaves unexplained.
    pub(super) const TEMPER: f64 = 0.12;
    /// Fraction of the gap left unexplained at which "none of these" is as likely as the best candidate, and its scale.
    pub(super) const LEFT: (f64, f64) = (0.22, 0.05);
    /// Probability that the cause is foreign even where a candidate leaves nothing.
    pub(super) const FOREIGN: f64 = 0.004;
}

/// Weighs single-effect explanations against each other, against none and against none of these.
///
/// ```text
/// P(effect) ∝ exp(−Δ/(2·T)),  T = 1 + TEMPER·left,   Δ distance to the best in penalised deviance
/// ```
pub(crate) fn odds(nominal_bic: f64, bics: &[f64], left: f64) -> Odds {
    let best = bics.iter().copied().fold(f64::INFINITY, f64::min);
    let gain = nominal_bic - best;
    let temperature = 1.0 + calibration::TEMPER * left.max(0.0);
    let weights: Vec<f64> = bics.iter().map(|b| (-(b - best) / (2.0 * temperature)).exp()).collect();
    let sum: f64 = weights.iter().sum::<f64>().max(1e-300);
    // Nothing missing: the gain is what the search finds in noise.
    let none = 1.0 / (1.0 + ((gain - SIGNIFICANT) / 6.0).clamp(-60.0, 60.0).exp());
    let fraction = left / (left + gain.max(1.0));
    let (middle, scale) = calibration::LEFT;
    let foreign = 1.0 / (1.0 + (-(fraction - middle) / scale).exp());
    let foreign = foreign.max(calibration::FOREIGN);
    let none = if gain < SIGNIFICANT { none * (-((left - IMMATERIAL) / 40.0).max(0.0)).exp() } else { none };
    let unexplained = (1.0 - none) * foreign;
    let rest = (1.0 - none - unexplained).max(0.0);
    Odds { effects: weights.iter().map(|w| rest * w / sum).collect(), none, unexplained }
}

/// The verdict on one or several effects.
pub(crate) fn verdict(
    ranked: &[(Effect, f64)],
    odds: &Odds,
    joint: Option<&Explanation>,
    left: Option<&Omnibus>,
    settings: &Settings,
) -> Verdict {
    let points_at = left.and_then(Omnibus::stage);
    if odds.none >= 0.5 {
        return Verdict {
            status: Status::None,
            effects: Vec::new(),
            class: Vec::new(),
            stage: None,
            probability: odds.none,
        };
    }
    if odds.unexplained >= 0.5 {
        return Verdict {
            status: Status::Unexplained,
            effects: Vec::new(),
            class: Vec::new(),
            stage: ranked.first().map(|r| r.0.stage()).filter(|_| points_at.is_none()).or(points_at),
            probability: odds.unexplained,
        };
    }
    let Some(&(first, p)) = ranked.first() else {
        return Verdict {
            status: Status::Unexplained,
            effects: Vec::new(),
            class: Vec::new(),
            stage: points_at,
            probability: odds.unexplained,
        };
    };
    if p >= settings.name_at {
        let effects = joint.map_or_else(|| vec![first], Explanation::effects);
        return Verdict {
            status: Status::Named,
            effects,
            class: Vec::new(),
            stage: Some(first.stage()),
            probability: p,
        };
    }
    let mut class = vec![first];
    let mut sum = p;
    for &(effect, p) in &ranked[1..] {
        if sum >= settings.name_at || p < 0.02 {
            break;
        }
        class.push(effect);
        sum += p;
    }
    let twins = class.len() > 1
        && class.iter().skip(1).all(|e| class.iter().any(|o| o != e && o.twins().contains(e)));
    let status = if twins { Status::Class } else { Status::Ambiguous };
    let stage = class.iter().all(|e| e.stage() == first.stage()).then(|| first.stage());
    Verdict { status, effects: Vec::new(), class, stage: stage.or(Some(first.stage())), probability: sum }
}
