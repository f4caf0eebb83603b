//! Effects that a source lacks and the machine has, and which of them are the cause.

use super::rows::{Row, RowKind};
use crate::effect::Effect;
use std::collections::BTreeSet;

/// Effects that the source lacks and the machine has, in the order of what they explain, each with its first row.
pub(crate) fn missing(rows: &[Row]) -> Vec<(Effect, &Row)> {
    let terms = rows.iter().filter(|row| row.differs && row.kind == RowKind::Effect && row.in_a == 0.0);
    let mut all: Vec<(Effect, &Row)> = Vec::new();
    for row in terms {
        let Some(effect) = row.effect.and_then(Effect::from_name) else { continue };
        if all.iter().all(|(other, _)| *other != effect) {
            all.push((effect, row));
        }
    }
    all
}

/// Whether more effects are missing than a verdict names, and not one difference alone keeps the gap open. Where several do, each only beside the
/// others, they imitate a cause that is none of them.
pub fn is_imitation(rows: &[Row]) -> bool {
    let keeps_open = |row: &&Row| row.differs && row.closure >= ESSENTIAL;
    let essential: BTreeSet<&str> =
        rows.iter().filter(keeps_open).map(|row| row.effect.unwrap_or(&row.what)).collect();
    missing(rows).len() > MOST_NAMED && essential.len() != 1
}

/// Most effects that a verdict names together.
const MOST_NAMED: usize = 2;

/// Share of the gap that must stay without an effect for it to be the cause by itself: nine tenths.
const ESSENTIAL: f64 = 0.9;

/// The effects that are the cause: those without which the gap would stay, whatever other values close beside them; else those that act, where the
/// aligned source explains the records.
pub(crate) fn causes(missing: &[(Effect, &Row)], explains: bool) -> Vec<Effect> {
    let essential = missing.iter().filter(|(_, row)| row.closure >= ESSENTIAL).map(|(effect, _)| *effect);
    let essential: Vec<Effect> = essential.take(MOST_NAMED).collect();
    if essential.is_empty() && explains { acting(missing) } else { essential }
}

/// The first of the effects missing, and those behind it without which more of the gap would stay than beside a cause by itself.
fn acting(missing: &[(Effect, &Row)]) -> Vec<Effect> {
    let acts = |number: usize, closure: f64| number == 0 || closure > 1.0 - ESSENTIAL;
    let acting = missing.iter().enumerate().filter(|(number, (_, row))| acts(*number, row.closure));
    acting.map(|(_, (effect, _))| *effect).take(MOST_NAMED).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use switchback_model::system::Unit;

    fn rows(closures: &[(Effect, f64)]) -> Vec<Row> {
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
        closures.iter().map(row).collect()
    }

    #[test]
    fn a_second_effect_acts_only_if_part_of_the_gap_would_stay_without_it() {
        let of = |closures: &[(Effect, f64)]| acting(&missing(&rows(closures)));
        assert_eq!(of(&[(Effect::Backlash, 0.8), (Effect::Creep, 0.05)]), [Effect::Backlash]);
        assert_eq!(
            of(&[(Effect::Backlash, 0.8), (Effect::Creep, 0.3), (Effect::Stribeck, 0.2)]),
            [Effect::Backlash, Effect::Creep]
        );
        assert_eq!(of(&[(Effect::Backlash, 0.05)]), [Effect::Backlash]);
    }

    #[test]
    fn an_essential_effect_is_the_cause_and_others_only_if_they_explain() {
        let of = |closures: &[(Effect, f64)], explains| causes(&missing(&rows(closures)), explains);
        let essential = [(Effect::Backlash, 0.5), (Effect::Creep, 0.95)];
        assert_eq!(of(&essential, false), [Effect::Creep]);
        let weak = [(Effect::Backlash, 0.5), (Effect::Creep, 0.4)];
        assert_eq!(of(&weak, true), [Effect::Backlash, Effect::Creep]);
        assert!(of(&weak, false).is_empty());
    }

    #[test]
    fn differences_that_keep_the_gap_open_beside_each_other_are_an_imitation() {
        let of = |closures: &[(Effect, f64)]| is_imitation(&rows(closures));
        assert!(!of(&[(Effect::Backlash, 1.0), (Effect::Creep, 1.0)]));
        assert!(of(&[(Effect::Backlash, 1.0), (Effect::Creep, 1.0), (Effect::Stribeck, 0.1)]));
        assert!(!of(&[(Effect::Backlash, 1.0), (Effect::Creep, 0.7), (Effect::Stribeck, 0.6)]));
        assert!(of(&[(Effect::Backlash, 0.6), (Effect::Creep, 0.7), (Effect::Stribeck, 0.6)]));
    }

    #[test]
    fn an_effect_of_two_rows_apart_is_one_difference() {
        let rows = rows(&[
            (Effect::Backlash, 1.0),
            (Effect::Creep, 0.5),
            (Effect::Backlash, 1.0),
            (Effect::Stribeck, 0.5),
        ]);
        assert_eq!(missing(&rows).len(), 3);
        assert!(!is_imitation(&rows));
    }
}
