//! From probabilities to a verdict.

use crate::attribution::pairs::Causes;
use crate::effect::Effect;
use crate::residuals::omnibus::Omnibus;
use crate::settings::Settings;
use crate::verdict::answer::{Status, Verdict, naming_nothing};
use crate::verdict::odds::{Odds, UNEXPLAINED};

/// Least probability of a rival.
const CLAIM: f64 = 0.04;

/// Rivals in one answer at most.
const WIDEST: usize = 3;
/// Probability from which the first of more rivals is still believed. Of fourteen made rigs with that many and a first one above a
/// half (0.57 to 0.73) all held the cause among the first three, twelve as the first; set just above a stand-in at 0.576 for a drift
/// that is no candidate, which costs one of the fourteen.
const PROBABLE: f64 = 0.58;

/// The verdict where no gap is resolved on the judged records and no candidate explains what remains of the error.
pub(crate) fn unresolved(odds: &Odds) -> Verdict {
    naming_nothing(Status::None, None, odds.none + odds.unexplained)
}

/// The verdict where the model describes the fit records but not the held-out ones: none of the candidates is the cause.
/// `ratio` is how many times as much the model errs there, in root mean square.
pub(crate) fn held_out_differs(odds: &Odds, ratio: f64) -> Verdict {
    let unexplained = naming_nothing(Status::Unexplained, None, odds.none + odds.unexplained);
    Verdict { held_out_error_ratio: Some(ratio), ..unexplained }
}

/// The verdict where identifying the model anew closes as much of the gap as any cause; `verdict` is that which shows one.
pub(crate) fn parameters_are_off(verdict: &Verdict) -> Verdict {
    naming_nothing(Status::Refit, None, verdict.probability)
}

/// The verdict on two effects where the colour of noise belongs to the model and is no cause: it takes what the law of the other one leaves.
pub(crate) fn without_colour(verdict: Verdict) -> Verdict {
    let (takes, effects): (Vec<Effect>, Vec<Effect>) =
        verdict.effects.iter().partition(|effect| effect.card().colours_noise);
    Verdict { effects, corrected_by: verdict.corrected_by.or(takes.first().copied()), ..verdict }
}

/// The verdict on one or several effects; `together` are those that a pair names.
pub(crate) fn verdict(
    ranked: &[(Effect, f64)],
    odds: &Odds,
    together: Option<&Causes>,
    left: Option<&Omnibus>,
    settings: &Settings,
) -> Verdict {
    let points_at = left.and_then(Omnibus::stage);
    if odds.none >= 0.5 {
        return naming_nothing(Status::None, None, odds.none);
    }
    if odds.unexplained >= UNEXPLAINED {
        let stage = points_at.or(ranked.first().map(|r| r.0.stage()));
        return naming_nothing(Status::Unexplained, stage, odds.unexplained);
    }
    let Some(&(first, p)) = ranked.first() else {
        return naming_nothing(Status::Unexplained, points_at, odds.unexplained);
    };
    if p >= settings.name_at {
        let effects = together.map_or_else(|| vec![first], |t| t.effects.clone());
        return Verdict {
            effects,
            stage: Some(first.stage()),
            corrected_by: together.and_then(|t| t.correction),
            ..naming_nothing(Status::Named, None, p)
        };
    }
    let mut rivals = vec![ranked[0]];
    for &rival in &ranked[1..] {
        // A cause that is not sure enough to be named has at least one rival.
        if rivals.len() > 1 && (sum(&rivals) >= settings.name_at || rival.1 < CLAIM) {
            break;
        }
        rivals.push(rival);
    }
    if rivals.len() > WIDEST && p < PROBABLE {
        // So many rivals, and none before the others, are stand-ins for something else.
        return naming_nothing(Status::Unexplained, points_at.or(Some(first.stage())), 1.0 - p);
    }
    rivals.truncate(WIDEST);
    let class: Vec<Effect> = rivals.iter().map(|r| r.0).collect();
    let confounded_effects = class.len() > 1
        && class.iter().skip(1).all(|e| class.iter().any(|o| o != e && o.confounded_effects().contains(e)));
    let status = if confounded_effects { Status::Class } else { Status::Ambiguous };
    let stage = class.iter().all(|e| e.stage() == first.stage()).then(|| first.stage());
    let stage = stage.or(Some(first.stage()));
    Verdict { class, ..naming_nothing(status, stage, sum(&rivals)) }
}

fn sum(rivals: &[(Effect, f64)]) -> f64 {
    rivals.iter().map(|r| r.1).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effect::Stage;

    fn of_rivals(probabilities: &[f64]) -> Verdict {
        let effects = [Effect::GainDrift, Effect::ExtraPole, Effect::SensorDrift, Effect::Backlash];
        let ranked: Vec<(Effect, f64)> = effects.into_iter().zip(probabilities.iter().copied()).collect();
        let odds = Odds { effects: probabilities.to_vec(), none: 0.0, unexplained: 0.02 };
        verdict(&ranked, &odds, None, None, &Settings::default())
    }

    #[test]
    fn a_probable_cause_keeps_its_first_rivals_where_there_are_many() {
        let ambiguous = of_rivals(&[0.6, 0.12, 0.11, 0.1]);
        assert_eq!(ambiguous.status, Status::Ambiguous);
        assert_eq!(ambiguous.class, [Effect::GainDrift, Effect::ExtraPole, Effect::SensorDrift]);
        assert!((ambiguous.probability - 0.83).abs() < 1e-9);
    }

    #[test]
    fn beside_a_cause_the_colour_of_noise_corrects_it() {
        let named = |effects: &[Effect]| Verdict {
            effects: effects.to_vec(),
            ..naming_nothing(Status::Named, Some(Stage::Disturbance), 0.9)
        };
        let beside = without_colour(named(&[Effect::ColouredNoise, Effect::Backlash]));
        assert_eq!((beside.status, &beside.effects[..]), (Status::Named, &[Effect::Backlash][..]));
        assert_eq!(beside.corrected_by, Some(Effect::ColouredNoise));
        assert_eq!(without_colour(named(&[Effect::Backlash])), named(&[Effect::Backlash]));
    }

    #[test]
    fn many_rivals_without_a_probable_one_are_stand_ins() {
        let unexplained = of_rivals(&[0.56, 0.12, 0.11, 0.1]);
        assert_eq!(unexplained.status, Status::Unexplained);
        assert!(unexplained.class.is_empty());
    }
}
