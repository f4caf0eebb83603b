//! How often the posterior is right on rigs of the training population that it was not trained on, each with a model given beforehand.
//!
//! A test fails where a binomial variable of the wanted rate would be as far off once in a thousand times.

use rayon::prelude::*;
use statrs::distribution::{Binomial, DiscreteCDF};
use switchback_diagnose::Effect;
use switchback_diagnose::evidence::Judged;
use switchback_diagnose::posterior::{Decision, Outcome, Posterior, decide};
use switchback_lab::population::{MeasuredBases, TrainingRig, draw_given};

/// Another population than that of the training.
const SEED: u64 = 0x7e57;

/// A rate below this probability under the wanted one is no accident.
const LEVEL: f64 = 1e-3;

/// Least share of faults whose likeliest outcome holds.
const FOUND: f64 = 0.6;

/// Largest shares of names that are wrong, and of rigs without a fault that are given a name.
const WRONG: f64 = 0.05;
const ALARMS: f64 = 0.01;

/// Largest error of the mean probability, and the quantile of a normal variable that 1 in 1000 exceeds in either direction.
const MISCALIBRATED: f64 = 0.06;
const Z999: f64 = 3.290_526_731_491_9;

/// What the posterior says of a rig.
struct Answer {
    is_fault: bool,
    /// Probability of the likeliest outcome, and whether it holds.
    likeliest: (f64, bool),
    /// Whether an effect is named, and whether it acts.
    named: Option<bool>,
}

impl Answer {
    fn of(rig: &TrainingRig) -> Option<Self> {
        let predicted = rig.rig.records.iter().map(|r| r.predicted.clone()).collect::<Option<Vec<_>>>()?;
        let judged = Judged::beside(&rig.rig, &predicted).ok()??;
        let outcome = rig.outcome(rig.truth.size)?;
        let posterior = Posterior::built_in();
        let named: Vec<(&str, f64)> =
            judged.evidence.columns.iter().map(|(name, value)| (name.as_str(), *value)).collect();
        let row = posterior.row(&named).expect("the columns of the training");
        let p = posterior.probabilities(&row, Posterior::ALL).expect("a population");
        let outcomes: Vec<Outcome> = posterior.classes.iter().map(|name| of_name(name)).collect();
        let names = rig.true_names();
        let holds = |k: usize| {
            let name = posterior.classes[k].as_str();
            name == outcome || names.contains(&name)
        };
        let first = (0..p.len()).max_by(|i, j| p[*i].total_cmp(&p[*j]))?;
        let is_outside = posterior.novelty.quantile(&row) >= 0.99;
        let named = match decide(&p, &outcomes, &posterior.thresholds, is_outside) {
            Decision::Named(k) => Some(holds(k)),
            _ => None,
        };
        Some(Self {
            is_fault: Effect::from_name(outcome).is_some(),
            likeliest: (p[first], holds(first)),
            named,
        })
    }
}

fn of_name(name: &str) -> Outcome {
    match name {
        Posterior::NOTHING => Outcome::Nothing,
        Posterior::NONE_OF_THESE => Outcome::NoneOfThese,
        _ => Outcome::Effect,
    }
}

fn binomial(rate: f64, trials: usize) -> Binomial {
    Binomial::new(rate, trials as u64).expect("a rate")
}

/// The probability of so many successes or more.
fn at_least(rate: f64, trials: usize, successes: usize) -> f64 {
    successes.checked_sub(1).map_or(1.0, |fewer| binomial(rate, trials).sf(fewer as u64))
}

#[test]
fn the_posterior_is_as_right_as_it_says_and_names_hardly_anything_wrong() {
    judged(60);
}

#[test]
#[ignore = "takes minutes"]
fn the_posterior_is_as_right_as_it_says_on_two_hundred_rigs() {
    judged(200);
}

/// The first rigs of the population that have a model and give evidence.
fn judged(rigs: usize) {
    let bases = MeasuredBases::default();
    // Half of all have a model, and not all of these give evidence.
    let judged: Vec<Answer> = (0..5 * rigs as u64 / 2)
        .into_par_iter()
        .filter_map(|number| Answer::of(&draw_given(SEED, number, &bases)?))
        .collect();
    let answers = &judged[..rigs];
    let count = |one: &dyn Fn(&&Answer) -> bool| answers.iter().filter(one).count();

    let (faults, found) = (count(&|a| a.is_fault), count(&|a| a.is_fault && a.likeliest.1));
    assert!(
        binomial(FOUND, faults).cdf(found as u64) > LEVEL,
        "the likeliest outcome holds for {found} of {faults} faults"
    );

    let (named, wrong) = (count(&|a| a.named.is_some()), count(&|a| a.named == Some(false)));
    assert!(at_least(WRONG, named, wrong) > LEVEL, "{wrong} of {named} names are wrong");
    let (others, alarms) = (count(&|a| !a.is_fault), count(&|a| !a.is_fault && a.named == Some(false)));
    assert!(
        at_least(ALARMS, others, alarms) > LEVEL,
        "an effect is named for {alarms} of {others} rigs without one"
    );

    let expected: f64 = answers.iter().map(|a| a.likeliest.0).sum();
    let right = count(&|a| a.likeliest.1) as f64;
    let se = answers.iter().map(|a| a.likeliest.0 * (1.0 - a.likeliest.0)).sum::<f64>().sqrt();
    assert!(
        (right - expected).abs() < MISCALIBRATED * rigs as f64 + Z999 * se,
        "{right} likeliest outcomes of {rigs} hold, {expected:.0} ± {se:.0} by their probabilities"
    );
}
