//! How often the diagnosis is right on twenty-eight rigs of the laboratory, none of which was chosen.
//!
//! A single verdict may change with every improvement of an estimator; a rate may not fall. The test fails where a binomial variable of the wanted
//! rate would be as low once in a thousand times.

use rayon::prelude::*;
use statrs::distribution::{Binomial, DiscreteCDF};
use switchback_diagnose::{Effect, Model, Settings, Status, Verdict, diagnose};
use switchback_lab::generate::{EFFECTS, MakeRig, RequestedFault, laws_of};

/// Rigs with one effect each; the laws of an effect take turns.
const WITH_ONE: u64 = 24;

/// Rigs without any.
const WITH_NONE: u64 = 4;

/// A rate below this probability under the wanted one is no accident.
const LEVEL: f64 = 1e-3;

/// The effect put into the rig of a number, and the verdict on it.
fn judged(number: u64) -> (Option<&'static str>, Verdict) {
    let recipe = MakeRig::new(0x5eed_0000 + number);
    let effect = (number < WITH_ONE).then(|| EFFECTS[number as usize % EFFECTS.len()]);
    let recipe = match effect {
        Some(effect) => {
            let law = number as usize / EFFECTS.len() % laws_of(effect).len();
            recipe.with(RequestedFault::with_law(effect, law, 2.0).expect("an effect"))
        }
        None => recipe,
    };
    let rig = recipe.make().expect("a rig").rig;
    (effect, diagnose(&rig, Model::Identify, &Settings::default()).expect("a diagnosis").verdict)
}

/// The probability of `successes` or fewer of `trials` under a rate.
fn chance(rate: f64, successes: usize, trials: usize) -> f64 {
    Binomial::new(rate, trials as u64).expect("a rate").cdf(successes as u64)
}

#[test]
fn most_single_effects_are_named_and_hardly_any_other_is() {
    let judged: Vec<_> = (0..WITH_ONE + WITH_NONE).into_par_iter().map(judged).collect();
    let names = |verdict: &Verdict| verdict.effects.iter().map(|e| Effect::name(*e)).collect::<Vec<_>>();
    let named: Vec<_> = judged.iter().filter(|(_, verdict)| verdict.status == Status::Named).collect();
    let right =
        named.iter().filter(|(effect, verdict)| effect.is_some_and(|e| names(verdict) == [e])).count();
    let others: Vec<_> = judged
        .iter()
        .filter(|(effect, verdict)| effect.is_none_or(|e| names(verdict) != [e]))
        .map(|(effect, verdict)| (effect, verdict.status, names(verdict)))
        .collect();
    let exact = chance(0.93, right, WITH_ONE as usize);
    assert!(
        exact > LEVEL,
        "{right} of {WITH_ONE} effects of size 2 are named exactly; the others: {others:?}"
    );
    let precise = chance(0.98, right, named.len());
    assert!(precise > LEVEL, "{right} of {} causes named are right; the others: {others:?}", named.len());
}
