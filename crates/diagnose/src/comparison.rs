//! What the records say of every effect, before anything is weighed.

use serde::{Deserialize, Serialize};

use crate::effect::Effect;
use crate::horizon::{Horizon, HorizonGain};

/// How candidates were compared with each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Comparison {
    /// By their predictions one step ahead.
    OneStep,
    /// By their free-run simulations.
    Simulation,
    /// By their free-run simulations, the parameters of the given model held.
    #[serde(rename = "given_model_held")]
    GivenModelFixed,
}

/// What the records say of one effect beside a nominal model.
///
/// Written as a row, to single precision: there are some hundred in the file of a diagnosis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(from = "Row", into = "Row")]
pub struct EffectEvidence {
    /// The effect.
    pub effect: Effect,
    /// Parameters that it adds.
    pub parameters: f64,
    /// Drop of the Bayesian information criterion.
    pub delta_bic: f64,
    /// Gain in log predictive score, nats per hold-out sample.
    pub heldout_log_score: f64,
    /// What it gains on the fit records, a horizon at a time, the nearest first; less where errors are no numbers.
    pub gains: Vec<HorizonGain>,
    /// Closure on the judged records; none where there is no gap to close, or the model is unstable.
    pub closure: Option<f64>,
    /// Whether it makes a held-out record worse beyond its error.
    #[serde(rename = "harms")]
    pub degrades_validation: bool,
    /// Whether the model with this effect has no free run: its output leaves every range, or its `A` is unstable.
    pub unstable: bool,
}

/// What one comparison says.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Compared {
    /// The comparison.
    pub comparison: Comparison,
    /// Samples fitted.
    pub samples: usize,
    /// Deviance that causes in general would still gain beside the nominal model, beyond chance.
    pub left_by_nominal: f64,
    /// The same beside the best effect that no held-out record refutes.
    pub left_by_best: f64,
    /// Lower end of the 90 % interval of the gap of the model under diagnosis on the judged records, and its estimate.
    pub gap: [f64; 2],
    /// How many times as much, in root mean square, the nominal model errs on the held-out records as on those fitted, where beyond chance.
    pub held_out_error_ratio: Option<f64>,
    /// Every effect with a fit of its own, the best in penalised deviance first.
    pub effects: Vec<EffectEvidence>,
}

impl Compared {
    /// What is said of an effect, if it has a fit.
    pub(crate) fn of(&self, effect: Effect) -> Option<&EffectEvidence> {
        self.effects.iter().find(|says| says.effect == effect)
    }
}

/// [`EffectEvidence`] as it is written: effect, parameters, drop of the criterion, held-out score, gains (samples ahead, 0 for whole records;
/// share, certainty), closure, harms, unstable.
#[derive(Serialize, Deserialize)]
struct Row(Effect, f32, f32, f32, Vec<(usize, f32, f32)>, Option<f32>, bool, bool);

/// In single precision, what lies beyond its range or is no number at the end of it.
fn single(x: f64) -> f32 {
    let most = f64::from(f32::MAX);
    if x.is_nan() { f32::MIN } else { x.clamp(-most, most) as f32 }
}

impl From<EffectEvidence> for Row {
    fn from(e: EffectEvidence) -> Self {
        let gain = |g: &HorizonGain| (g.horizon.samples(), single(g.share), single(g.certainty));
        Self(
            e.effect,
            single(e.parameters),
            single(e.delta_bic),
            single(e.heldout_log_score),
            e.gains.iter().map(gain).collect(),
            e.closure.map(single),
            e.degrades_validation,
            e.unstable,
        )
    }
}

impl From<Row> for EffectEvidence {
    fn from(
        Row(effect, parameters, delta_bic, score, gains, closure, degrades_validation, unstable): Row,
    ) -> Self {
        let gain = |(samples, share, certainty): (usize, f32, f32)| HorizonGain {
            horizon: Horizon::of_samples(samples),
            share: f64::from(share),
            certainty: f64::from(certainty),
        };
        Self {
            effect,
            parameters: f64::from(parameters),
            delta_bic: f64::from(delta_bic),
            heldout_log_score: f64::from(score),
            gains: gains.into_iter().map(gain).collect(),
            closure: closure.map(f64::from),
            degrades_validation,
            unstable,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_back_to_single_precision() {
        let gain = |horizon, share| HorizonGain { horizon, share, certainty: -2.5 };
        let evidence = EffectEvidence {
            effect: Effect::Backlash,
            parameters: 2.0,
            delta_bic: 1234.5,
            heldout_log_score: f64::NEG_INFINITY,
            gains: vec![
                gain(Horizon::Step, 0.25),
                gain(Horizon::Samples(12), 0.5),
                gain(Horizon::FreeRun, 0.75),
            ],
            closure: None,
            degrades_validation: true,
            unstable: false,
        };
        let text = serde_json::to_string(&evidence).unwrap();
        assert!(text.starts_with("[\"backlash\",2.0,1234.5,"), "{text}");
        let read: EffectEvidence = serde_json::from_str(&text).unwrap();
        let expected = EffectEvidence { heldout_log_score: f64::from(f32::MIN), ..evidence };
        assert_eq!(read, expected);
    }
}
