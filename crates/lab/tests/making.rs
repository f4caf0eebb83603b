//! What a made rig promises, over all effects and laws.

use switchback_lab::generate::{
    EFFECTS, FOREIGN, MadeRig, MakeError, MakeRig, Nature, Plan, RequestedFault, laws_of,
};
use switchback_model::rig::Usage;

fn short() -> Plan {
    Plan { step: 300, periods: 30, sweep: 1500, drive: 600, repeat_periods: 5 }
}

fn each_law() -> impl Iterator<Item = (&'static str, usize)> {
    EFFECTS
        .iter()
        .chain(&FOREIGN)
        .flat_map(|&effect| (0..laws_of(effect).len()).map(move |law| (effect, law)))
}

fn make(effect: &str, law: usize, size: f64, seed: u64) -> MadeRig {
    let requested_fault = RequestedFault::with_law(effect, law, size).unwrap();
    MakeRig::new(seed).plan(short()).with(requested_fault).make().unwrap()
}

#[test]
fn every_name_has_a_law_and_every_law_knows_its_name() {
    for (effect, law) in each_law() {
        assert_eq!(laws_of(effect)[law].effect(), effect);
    }
    assert!(EFFECTS.iter().chain(&FOREIGN).all(|e| !laws_of(e).is_empty()));
}

#[test]
fn the_asked_size_is_reached_by_nearly_every_law() {
    let mut short_of = Vec::new();
    for (effect, law) in each_law() {
        let made = make(effect, law, 1.0, 11);
        let truth = &made.key.effects[0];
        assert!(truth.size <= 1.03, "{effect} {law}: {}", truth.size);
        if truth.size < 0.97 {
            short_of.push(format!("{effect} {}: {:.2}", truth.law, truth.size));
        }
    }
    assert!(short_of.len() <= 4, "{short_of:?}");
}

#[test]
fn a_rig_without_effect_leaves_nothing_behind() {
    for seed in 0..12 {
        let made = MakeRig::new(seed).plan(short()).make().unwrap();
        assert!(made.key.effects.is_empty());
        assert!(made.key.size < 0.12, "seed {seed}: {}", made.key.size);
    }
}

#[test]
fn the_same_recipe_gives_the_same_rig_and_another_seed_another() {
    let one = make("backlash", 0, 1.0, 3);
    let again = make("backlash", 0, 1.0, 3);
    assert_eq!((&one.rig, &one.key), (&again.rig, &again.key));
    assert_ne!(one.rig, make("backlash", 0, 1.0, 4).rig);
}

#[test]
fn a_rig_made_again_from_its_key_is_the_same_to_the_bit() {
    for effect in ["backlash", "outliers", "border_wear"] {
        let recipe = MakeRig::new(9).plan(short()).with(RequestedFault::with_law(effect, 1, 4.0).unwrap());
        let made = recipe.make().unwrap();
        let again = recipe.again(&made.key).unwrap();
        assert_eq!((&made.rig, &made.key, &made.truth), (&again.rig, &again.key, &again.truth));
        assert!(matches!(MakeRig::new(9).again(&made.key), Err(MakeError::ForeignKey { .. })));
    }
}

#[test]
fn an_effect_changes_the_output_and_nothing_else_that_is_drawn() {
    let without = MakeRig::new(5).plan(short()).make().unwrap();
    let with = make("creep", 0, 2.0, 5);
    assert_eq!((&without.key.a, &without.key.b), (&with.key.a, &with.key.b));
    for (x, y) in without.rig.records.iter().zip(&with.rig.records) {
        assert_eq!(x.record.v(), y.record.v());
        assert_ne!(x.record.y(), y.record.y());
    }
}

#[test]
fn noise_effects_leave_the_repeating_output_alone() {
    let without = MakeRig::new(6).plan(short()).make().unwrap();
    for (effect, law) in each_law().filter(|(e, l)| laws_of(e)[*l].nature() == Nature::Noise) {
        let with = make(effect, law, 1.0, 6);
        for (x, y) in without.truth.iter().zip(&with.truth) {
            assert_eq!(x.repeating, y.repeating, "{effect} law {law}");
        }
    }
}

#[test]
fn surviving_energy_is_the_size() {
    let made = make("gradual_transition", 0, 2.0, 8);
    let fit: Vec<f64> = made
        .truth
        .iter()
        .zip(&made.rig.records)
        .filter(|(_, r)| r.usage == Usage::Fit)
        .flat_map(|(t, _)| t.surviving[t.first..].iter().copied())
        .collect();
    let rms = (fit.iter().map(|x| x * x).sum::<f64>() / fit.len() as f64).sqrt();
    assert!((rms / made.key.size - 1.0).abs() < 0.08, "{rms} against {}", made.key.size);
}

#[test]
fn impossible_recipes_say_what_is_wrong() {
    assert!(matches!(RequestedFault::plain("blacklash", 1.0), Err(MakeError::UnknownEffect { .. })));
    assert!(matches!(RequestedFault::plain("backlash", -1.0), Err(MakeError::Size(_))));
    assert!(matches!(RequestedFault::with_law("creep", 9, 1.0), Err(MakeError::UnknownLaw { laws: 3, .. })));
}
