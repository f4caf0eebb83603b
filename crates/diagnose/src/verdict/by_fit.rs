//! From fitted probabilities to a verdict.

use crate::effect::Effect;
use crate::verdict::answer::{Status, Verdict, naming_nothing};
use crate::verdict::fitted::weighed::Weighed;

/// Effects in one answer at most.
const WIDEST: usize = 3;
/// Probability from which a class is reported: a wrong one costs twice what a right one is worth, and silence nothing (C. K. Chow, "On optimum
/// recognition error and reject tradeoff", IEEE Trans. Inf. Theory 16, 1970).
const LIKELY: f64 = 2.0 / 3.0;

/// The verdict on one effect, on a few, on nothing or on none of these.
///
/// ```text
/// named         the first has probability `name_at`, evidence like this was met before, and it degrades no held-out record
/// class         else the fewest, two or three, that have `name_at` together, or else two thirds
/// none          else nothing is likelier to be missing than a cause that is none of the candidates
/// ```
///
/// `degrades_validation` shows that the first makes a held-out record worse.
pub(crate) fn verdict(weighed: &Weighed, (name_at, degrades_validation): (f64, bool)) -> Verdict {
    let calibrated = |verdict: Verdict| Verdict { calibrated: weighed.is_met, ..verdict };
    let first = weighed.effects.first();
    if let Some((effect, p)) = first.filter(|(_, p)| *p >= name_at && weighed.is_met && !degrades_validation)
    {
        let named = naming_nothing(Status::Named, Some(effect.stage()), *p);
        return calibrated(Verdict { effects: vec![*effect], ..named });
    }
    let rivals = &weighed.effects[..weighed.effects.len().min(WIDEST)];
    let sum = |of: usize| rivals[..of].iter().map(|(_, p)| p).sum::<f64>();
    let enough = |least: f64| (2..=rivals.len()).find(|of| sum(*of) >= least);
    if let Some(of) = enough(name_at).or_else(|| enough(LIKELY)) {
        let class: Vec<Effect> = rivals[..of].iter().map(|(effect, _)| *effect).collect();
        let are_confounded_effects =
            class.iter().skip(1).all(|e| class.iter().any(|o| o != e && o.confounded_effects().contains(e)));
        let status = if are_confounded_effects { Status::Class } else { Status::Ambiguous };
        let reported = naming_nothing(status, Some(class[0].stage()), sum(of));
        return calibrated(Verdict { class, ..reported });
    }
    if weighed.none >= weighed.none_of_these {
        return calibrated(naming_nothing(Status::None, None, weighed.none));
    }
    let stage = first.map(|(effect, _)| effect.stage());
    calibrated(naming_nothing(Status::Unexplained, stage, weighed.none_of_these))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reported(effects: &[(Effect, f64)], none: f64) -> Verdict {
        let sum: f64 = effects.iter().map(|(_, p)| p).sum();
        let none_of_these = 1.0 - none - sum;
        let effects = effects.to_vec();
        let weighed = Weighed { effects, none, none_of_these, is_met: true };
        verdict(&weighed, (0.85, false))
    }

    #[test]
    fn what_is_likely_enough_is_named_unless_it_degrades_validation_or_was_never_met() {
        let effects = vec![(Effect::Creep, 0.9), (Effect::Backlash, 0.05)];
        let weighed = Weighed { effects, none: 0.03, none_of_these: 0.02, is_met: true };
        let named = verdict(&weighed, (0.85, false));
        assert_eq!((named.status, named.calibrated), (Status::Named, true));
        assert_eq!(named.effects, [Effect::Creep]);
        let harming = verdict(&weighed, (0.85, true));
        assert_eq!((harming.status, harming.class.len()), (Status::Ambiguous, 2));
        let strange = verdict(&Weighed { is_met: false, ..weighed }, (0.85, false));
        assert_eq!((strange.status, strange.calibrated), (Status::Ambiguous, false));
    }

    #[test]
    fn a_class_is_as_small_as_its_probability_allows() {
        let two = reported(&[(Effect::Creep, 0.5), (Effect::Backlash, 0.4), (Effect::GainDrift, 0.02)], 0.03);
        assert_eq!((two.status, &two.class[..]), (Status::Ambiguous, &[Effect::Creep, Effect::Backlash][..]));
        assert!((two.probability - 0.9).abs() < 1e-12);
        let three = reported(&[(Effect::Creep, 0.3), (Effect::Backlash, 0.2), (Effect::GainDrift, 0.2)], 0.2);
        assert_eq!(three.class.len(), 3);
        let confounded_effects = reported(&[(Effect::Backlash, 0.5), (Effect::GradualTransition, 0.4)], 0.05);
        assert_eq!(confounded_effects.status, Status::Class);
    }

    #[test]
    fn without_a_likely_cause_nothing_or_none_of_these_is_reported() {
        let few = [(Effect::Creep, 0.2), (Effect::Backlash, 0.1), (Effect::GainDrift, 0.1)];
        let none = reported(&few, 0.4);
        assert_eq!((none.status, none.probability), (Status::None, 0.4));
        let unexplained = reported(&few, 0.2);
        assert_eq!(
            (unexplained.status, unexplained.stage),
            (Status::Unexplained, Some(Effect::Creep.stage()))
        );
        assert!((unexplained.probability - 0.4).abs() < 1e-12);
    }
}
