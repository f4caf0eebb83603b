//! Every reservation about a fit: a record made so that it must be reported, and one where it must not.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use switchback_identify::free::*;
use switchback_model::hysteresis::{BorderPair, Interval, SwitchedHysteresis};
use switchback_model::linear::filter;
use switchback_model::record::Record;
use switchback_model::reversal::{Branches, ReversalRule, Timing};

/// Borders as plain functions: (descending, ascending).
#[derive(Debug, Clone, Copy)]
struct Pair(fn(f64) -> f64, fn(f64) -> f64);

impl BorderPair for Pair {
    fn descending(&self, v: f64) -> f64 {
        self.0(v)
    }
    fn ascending(&self, v: f64) -> f64 {
        self.1(v)
    }
}

const SPRING: Pair = Pair(|v| 0.5 * v - 0.3, |v| 0.5 * v + 0.3);
const LINE: Pair = Pair(|v| 0.8 * v, |v| 0.8 * v);
const CURVE: Pair = Pair(|v| 0.2 * v + 0.6 * v * v * v, |v| 0.2 * v + 0.6 * v * v * v);

const A: [f64; 2] = [-1.1, 0.4];
const B: [f64; 2] = [0.8, -0.3];

fn normals(seed: u64, count: usize, sd: f64) -> Vec<f64> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    (0..count).map(|_| sd * Distribution::<f64>::sample(&StandardNormal, &mut rng)).collect()
}

fn random_levels(seed: u64, count: usize) -> Vec<f64> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    (0..count).map(|_| rng.random_range(-1.0..1.0)).collect()
}

/// A smooth motion with reversals of many sizes.
fn smooth(count: usize) -> Vec<f64> {
    let wave = |t: f64| 0.55 * (0.041 * t).sin() + 0.25 * (0.0931 * t + 1.0).sin() + 0.2 * (0.017 * t).cos();
    (0..count).map(|t| wave(t as f64)).collect()
}

/// What a machine answers to `v`, with white equation error.
fn measured(pair: Pair, a: &[f64], b: &[f64], v: Vec<f64>, sd: f64) -> Record {
    let operator = SwitchedHysteresis::new(Interval::new(-1.0, 1.0).unwrap(), Box::new(pair)).unwrap();
    let y = filter(a, b, &operator.output(&v, 0.0), &normals(77, v.len(), sd), 0.0, 0.0);
    Record::new(v, y).unwrap()
}

/// One structure, one rule: nothing is searched for.
fn known(order: usize, delay: isize, knots: usize) -> Settings {
    Settings {
        order: Some(order),
        delay: Some(delay),
        knots: Some(knots),
        timing: Some(Timing::AtSamples),
        ..Settings::new(InputMap::Borders)
    }
}

fn kinds(record: &Record, settings: Settings) -> Vec<&'static str> {
    let found = identify(&[record], &settings).unwrap();
    for warning in &found.warnings {
        assert!(!warning.to_string().contains("NaN"), "{warning}");
    }
    found.warnings.iter().map(Warning::kind).collect()
}

#[test]
fn a_sound_fit_raises_none() {
    let record = measured(SPRING, &A, &B, random_levels(1, 2000), 0.02);
    assert_eq!(kinds(&record, known(2, 0, 2)), [""; 0]);
}

#[test]
fn equal_borders_are_a_loop_that_vanished_and_a_spring_s_are_not() {
    for (pair, knots, vanished) in [(LINE, 2, true), (CURVE, 6, true), (SPRING, 2, false), (SPRING, 6, false)]
    {
        for v in [random_levels(2, 2000), smooth(2000)] {
            let found = kinds(&measured(pair, &A, &B, v, 0.02), known(2, 0, knots));
            assert_eq!(found.contains(&"loop_vanished"), vanished, "{pair:?}, {knots} knots: {found:?}");
        }
    }
}

#[test]
fn lines_between_few_knots_do_not_make_a_loop_of_one_curve() {
    // So little noise that any difference of interpolation is far beyond the errors.
    let found = kinds(&measured(CURVE, &A, &B, smooth(4000), 1e-4), known(2, 0, 5));
    assert!(found.contains(&"loop_vanished"), "{found:?}");
}

#[test]
fn the_share_of_the_stroke_that_is_distinguished_is_that_of_the_loop() {
    /// Two borders that part at the middle of the stroke.
    const HALF: Pair = Pair(|v| v.min(0.0), |v| v.min(0.0) + 0.6 * v.max(0.0));
    let record = measured(HALF, &A, &B, random_levels(3, 4000), 0.02);
    let distance = identify(&[&record], &known(2, 0, 9)).unwrap().distance.unwrap();
    assert!(distance.distinguished > 0.3 && distance.distinguished < 0.6, "{distance:?}");
    assert!(distance.clearest.v > 0.0 && distance.clearest.difference.abs() > 0.1);
}

#[test]
fn an_order_too_high_is_ill_conditioned_and_its_coefficients_are_hollow() {
    let record = measured(SPRING, &[-0.6], &[0.5], random_levels(4, 2000), 1e-6);
    let found = kinds(&record, known(4, 0, 2));
    assert!(found.contains(&"ill_conditioned"), "{found:?}");
    let noisy = measured(SPRING, &[-0.9], &[0.5], smooth(2000), 0.05);
    let found = kinds(&noisy, known(4, 0, 2));
    assert!(found.contains(&"coefficient_not_told"), "{found:?}");
    let found = kinds(&noisy, known(1, 0, 2));
    assert!(!found.contains(&"ill_conditioned") && !found.contains(&"coefficient_not_told"), "{found:?}");
}

#[test]
fn a_numerator_that_cancels_leaves_no_gain_and_an_integrator_no_bounds() {
    let reported = |a: &[f64], b: &[f64]| {
        let record = measured(SPRING, a, b, random_levels(5, 1500), 0.1);
        let found = identify(&[&record], &known(a.len(), 0, 2)).unwrap();
        let polynomial = |w: &Warning| match w {
            Warning::GainNotReported { polynomial, .. } => Some(*polynomial),
            _ => None,
        };
        found.warnings.iter().filter_map(polynomial).collect::<String>()
    };
    assert_eq!(reported(&A, &[0.8, -0.8]), "B");
    assert_eq!(reported(&[-0.9999], &[0.5]), "A");
    assert_eq!(reported(&A, &B), "");
}

/// The same machine, whose output answers `samples` before the input shows.
fn ahead(record: &Record, samples: usize) -> Record {
    let count = record.len() - samples;
    Record::new(record.v()[..count].to_vec(), record.y()[samples..].to_vec()).unwrap()
}

#[test]
fn a_look_ahead_that_is_not_there_is_reported_and_one_that_is_there_is_not_doubted() {
    let record = measured(SPRING, &A, &B, random_levels(6, 2000), 0.02);
    let found = kinds(&record, known(2, -2, 2));
    assert!(found.contains(&"look_ahead_not_told") && found.contains(&"looks_ahead"), "{found:?}");
    let found = kinds(&ahead(&record, 2), known(2, -2, 2));
    assert!(!found.contains(&"look_ahead_not_told") && found.contains(&"looks_ahead"), "{found:?}");
    assert!(!kinds(&record, known(2, -1, 2)).contains(&"looks_ahead"));
}

/// Whether the output up to any sample is the same without what follows.
fn runs_in_real_time(model: &Model, v: &[f64]) -> bool {
    let whole = model.simulate(v, &[0.0]);
    (v.len() / 2..v.len()).all(|end| {
        let part = model.simulate(&v[..end], &[0.0]);
        part.iter().zip(&whole).all(|(x, y)| (x - y).abs() < 1e-9)
    })
}

#[test]
fn a_causal_model_never_needs_what_follows_and_the_others_say_that_they_do() {
    let noisy: Vec<f64> = smooth(1500).iter().zip(normals(8, 1500, 0.004)).map(|(x, e)| x + e).collect();
    let operator = SwitchedHysteresis::new(Interval::new(-1.1, 1.1).unwrap(), Box::new(SPRING)).unwrap();
    let y = filter(&A, &B, &operator.output(&smooth(1500), 0.0), &normals(9, 1500, 0.01), 0.0, 0.0);
    let record = ahead(&Record::new(noisy, y).unwrap(), 2);
    let settings =
        |causal| Settings { causal, knots: Some(3), order: Some(2), ..Settings::new(InputMap::Borders) };
    let best = identify(&[&record], &settings(false)).unwrap().model;
    let causal = identify(&[&record], &settings(true)).unwrap().model;
    assert!(!best.is_causal() && !runs_in_real_time(&best, &record.v()[..300]));
    assert!(causal.is_causal() && runs_in_real_time(&causal, &record.v()[..300]));
    assert!(causal.structure().delay >= -1 && causal.rule().timing == Timing::AtConfirmation);
    let price = best.free_run(&record).fit_percent - causal.free_run(&record).fit_percent;
    assert!(price > 1.0, "{price}");
    let refused = identify(&[&record], &Settings { delay: Some(-2), ..settings(true) }).unwrap_err();
    assert!(matches!(refused, FreeError::Setting { name: "delay", .. }), "{refused}");
}

#[test]
fn confirmed_reversals_need_no_future_and_without_a_threshold_are_the_exact_ones() {
    let rule = |threshold| ReversalRule { threshold, band: 0.0, timing: Timing::AtConfirmation };
    let v = random_levels(10, 300);
    let exact = Branches::of(&v, ReversalRule::EXACT).unwrap();
    assert_eq!(Branches::of(&v, rule(0.0)).unwrap(), exact);
    let whole = Branches::of(&v, rule(0.4)).unwrap();
    for end in whole.first_known() + 1..v.len() {
        let part = Branches::of(&v[..end], rule(0.4)).unwrap();
        let known = whole.first_known();
        assert_eq!(part.labels()[known..], whole.labels()[known..end], "{end} samples");
    }
    assert!(whole.reversals() > 50);
}

#[test]
fn the_errors_of_the_gain_and_the_levels_cover_what_they_say() {
    let (replicates, samples) = (150u64, 800);
    let operator = SwitchedHysteresis::new(Interval::new(-1.0, 1.0).unwrap(), Box::new(SPRING)).unwrap();
    // u_M − u_m = 1.6, B(1)/A(1) = 0.5/0.3.
    let truth = [1.6 * 0.5 / 0.3, 0.8 * 0.5 / 0.3, -0.8 * 0.5 / 0.3];
    let mut z = [const { Vec::new() }; 3];
    for seed in 0..replicates {
        let v = random_levels(seed, samples);
        let y = filter(&A, &B, &operator.output(&v, 0.0), &normals(seed + 500, samples, 0.1), 0.0, 0.0);
        let settings = Settings { refine: false, interval: Some(operator.interval()), ..known(2, 0, 2) };
        let found = identify(&[&Record::new(v, y).unwrap()], &settings).unwrap();
        let (e, errors) = (&found.estimate, found.level_errors.unwrap());
        let pairs = [(e.gain, errors.gain), (e.y_high, errors.y_high), (e.y_low, errors.y_low)];
        for (i, (value, se)) in pairs.into_iter().enumerate() {
            z[i].push((value - truth[i]) / se);
        }
    }
    for (i, z) in z.iter().enumerate() {
        let variance = z.iter().map(|z| z * z).sum::<f64>() / replicates as f64;
        // Four Monte-Carlo standard errors about 1.
        assert!((variance - 1.0).abs() < 4.0 * (2.0 / replicates as f64).sqrt(), "level {i}: {variance}");
    }
}
