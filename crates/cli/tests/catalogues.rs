//! The maker makes what the diagnosis knows, under the same names: two catalogues that share no code.

use switchback_diagnose::Effect;
use switchback_lab::generate::{EFFECTS, FOREIGN, laws_of};

#[test]
fn every_effect_of_the_diagnosis_can_be_made_and_the_other_way_round() {
    let mut known = Effect::ALL.map(Effect::name);
    let mut made = EFFECTS;
    known.sort_unstable();
    made.sort_unstable();
    assert_eq!(known, made);
    for effect in Effect::ALL {
        let plain = laws_of(effect.name()).first().expect("a law");
        assert_eq!(plain.effect(), effect.name());
        assert_eq!(plain.stage().name(), effect.stage().name(), "{effect}");
    }
}

#[test]
fn what_no_diagnosis_is_expected_to_know_has_no_effects_name() {
    let known: Vec<&str> = FOREIGN.into_iter().filter(|name| Effect::from_name(name).is_some()).collect();
    assert!(known.is_empty(), "{known:?}");
}
