//! From probabilities to a verdict.

use crate::diagnosis::{Status, Verdict};
use crate::effect::{Effect, Stage};
use crate::odds::{Odds, UNEXPLAINED};
use crate::omnibus::Omnibus;
use crate::pairs::Causes;
use crate::settings::Settings;

/// Least probability of a rival.
const CLAIM: f64 = 0.04;

/// Rivals in one answer at most.
const WIDEST: usize = 3;

fn naming_nothing(status: Status, stage: Option<Stage>, probability: f64) -> Verdict {
    Verdict { status, effects: Vec::new(), class: Vec::new(), stage, probability, corrected_by: None }
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
            status: Status::Named,
            effects,
            class: Vec::new(),
            stage: Some(first.stage()),
            probability: p,
            corrected_by: together.and_then(|t| t.correction),
        };
    }
    let mut class = vec![first];
    let mut sum = p;
    for &(effect, p) in &ranked[1..] {
        // A cause that is not sure enough to be named has at least one rival.
        if class.len() > 1 && (sum >= settings.name_at || p < CLAIM) {
            break;
        }
        class.push(effect);
        sum += p;
    }
    if class.len() > WIDEST {
        // So many rivals are stand-ins for something else.
        return naming_nothing(Status::Unexplained, points_at.or(Some(first.stage())), 1.0 - p);
    }
    let twins = class.len() > 1
        && class.iter().skip(1).all(|e| class.iter().any(|o| o != e && o.twins().contains(e)));
    let status = if twins { Status::Class } else { Status::Ambiguous };
    let stage = class.iter().all(|e| e.stage() == first.stage()).then(|| first.stage());
    let stage = stage.or(Some(first.stage()));
    Verdict { status, effects: Vec::new(), class, stage, probability: sum, corrected_by: None }
}
