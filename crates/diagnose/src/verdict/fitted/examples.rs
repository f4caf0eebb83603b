//! Made evidence for tests.

use super::calibration::{Example, Holds};
use crate::comparison::{Compared, Comparison, EffectEvidence};
use crate::effect::Effect;
use crate::horizon::{Horizon, HorizonGain};
use crate::testing::white;
use crate::verdict::answer::Status;
use crate::verdict::answer::naming_nothing;

/// What is said of an effect of two parameters that gains the same at all horizons.
pub(in crate::verdict) fn says(effect: Effect, delta_bic: f64, share: f64, certainty: f64) -> EffectEvidence {
    let gain = |horizon| HorizonGain { horizon, share, certainty };
    EffectEvidence {
        effect,
        parameters: 2.0,
        delta_bic,
        heldout_log_score: 0.0,
        gains: [Horizon::Step, Horizon::Samples(30), Horizon::FreeRun].map(gain).to_vec(),
        closure: Some(0.0),
        degrades_validation: false,
        unstable: false,
    }
}

pub(in crate::verdict) fn compared(comparison: Comparison, effects: Vec<EffectEvidence>) -> Compared {
    Compared {
        comparison,
        samples: 1000,
        left_by_nominal: 50.0,
        left_by_best: 10.0,
        gap: [0.01, 0.02],
        held_out_error_ratio: None,
        effects,
    }
}

/// Rigs on eight bases with one of four effects, or none of them, or nothing: the true one has the larger gain as a rule.
pub(in crate::verdict) fn rigs(count: usize) -> Vec<Example> {
    let effects = [Effect::Creep, Effect::Backlash, Effect::GainDrift, Effect::Stribeck];
    let mut noise = white();
    let one = |k: usize| {
        let truth = k % 6;
        let of = |(j, effect): (usize, &Effect)| {
            let gain = if j == truth { 3.0 } else { 0.0 } + noise();
            says(*effect, 60.0 * gain.exp(), (0.2 * gain).clamp(-0.9, 0.9), 2.0 * gain)
        };
        let says = effects.iter().enumerate().map(of).collect();
        let left = if truth == 5 { 900.0 } else { 10.0 };
        let evidence = vec![Compared { left_by_best: left, ..compared(Comparison::OneStep, says) }];
        Example {
            base: format!("base {}", k / 6 % 8),
            law: (truth < 4).then(|| format!("law {}", (k / 7) % 3)),
            evidence,
            excluded: Vec::new(),
            holds: Holds {
                effects: effects.get(truth).copied().into_iter().collect(),
                none: truth == 4,
                none_of_these: truth == 5,
            },
            rules: (naming_nothing(Status::None, None, 0.5), None),
            by_rules: 0.2,
        }
    };
    (0..count).map(one).collect()
}
