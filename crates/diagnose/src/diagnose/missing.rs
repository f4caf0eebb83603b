//! Effects that a source lacks and the machine has, and which of them are the cause.

use crate::differences::{Differences, Row, RowKind};
use crate::effect::Effect;

/// Effects that the source lacks and the machine has, in the order of what they explain.
pub(super) fn missing(found: &Differences) -> Vec<(Effect, &Row)> {
    let terms = found.rows.iter().filter(|row| row.differs && row.kind == RowKind::Effect && row.in_a == 0.0);
    let mut all: Vec<(Effect, &Row)> = Vec::new();
    for row in terms {
        let Some(effect) = row.effect.and_then(Effect::from_name) else { continue };
        if all.iter().all(|(other, _)| *other != effect) {
            all.push((effect, row));
        }
    }
    all
}

/// Most effects that a verdict names together.
pub(super) const MOST_NAMED: usize = 2;

/// Share of the gap that must stay without an effect for it to be the cause by itself: nine tenths.
pub(super) const ESSENTIAL: f64 = 0.9;

/// Whether more effects are missing than a verdict names, and not one difference alone keeps the gap open. Where several do, each only beside the others, they
/// imitate a cause that is none of them.
pub(super) fn are_together_another(found: &[Row], missing: &[(Effect, &Row)]) -> bool {
    let mut essential: Vec<&str> = found
        .iter()
        .filter(|row| row.differs && row.closure >= ESSENTIAL)
        .map(|row| row.effect.unwrap_or(&row.what))
        .collect();
    essential.dedup();
    missing.len() > MOST_NAMED && essential.len() != 1
}

/// The first of the effects missing, and those behind it without which more of the gap would stay than beside a cause by itself.
pub(super) fn acting(missing: &[(Effect, &Row)]) -> Vec<Effect> {
    let acts = |number: usize, closure: f64| number == 0 || closure > 1.0 - ESSENTIAL;
    let acting = missing.iter().enumerate().filter(|(number, (_, row))| acts(*number, row.closure));
    acting.map(|(_, (effect, _))| *effect).take(MOST_NAMED).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use switchback_model::system::Unit;

    fn rows(closures: &[(Effect, f64)]) -> Vec<(Effect, Row)> {
        let row = |(effect, closure): &(Effect, f64)| Row {
            what: "strength".to_owned(),
            effect: Some(effect.name()),
            kind: RowKind::Effect,
            in_a: 0.0,
            in_b: 1.0,
            se_a: 0.0,
            se: 0.1,
            unit: Unit::One,
            probability: 1.0,
            differs: true,
            closure: *closure,
            gain: 1.0,
        };
        closures.iter().map(|one| (one.0, row(one))).collect()
    }

    fn referred(rows: &[(Effect, Row)]) -> Vec<(Effect, &Row)> {
        rows.iter().map(|(effect, row)| (*effect, row)).collect()
    }

    #[test]
    fn a_second_effect_acts_only_if_part_of_the_gap_would_stay_without_it() {
        let weak = rows(&[(Effect::Backlash, 0.8), (Effect::Creep, 0.05)]);
        assert_eq!(acting(&referred(&weak)), [Effect::Backlash]);
        let both = rows(&[(Effect::Backlash, 0.8), (Effect::Creep, 0.3), (Effect::Stribeck, 0.2)]);
        assert_eq!(acting(&referred(&both)), [Effect::Backlash, Effect::Creep]);
        let faint = rows(&[(Effect::Backlash, 0.05)]);
        assert_eq!(acting(&referred(&faint)), [Effect::Backlash]);
    }

    #[test]
    fn several_without_which_the_gap_stays_stand_for_another() {
        let of = |closures: &[(Effect, f64)]| {
            let all = rows(closures);
            let found: Vec<Row> = all.iter().map(|(_, row)| row.clone()).collect();
            are_together_another(&found, &referred(&all))
        };
        assert!(!of(&[(Effect::Backlash, 1.0), (Effect::Creep, 1.0)]));
        assert!(of(&[(Effect::Backlash, 1.0), (Effect::Creep, 1.0), (Effect::Stribeck, 0.1)]));
        assert!(!of(&[(Effect::Backlash, 1.0), (Effect::Creep, 0.7), (Effect::Stribeck, 0.6)]));
        assert!(of(&[(Effect::Backlash, 0.6), (Effect::Creep, 0.7), (Effect::Stribeck, 0.6)]));
    }
}
