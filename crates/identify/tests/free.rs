//! Identification from any record, on rigs simulated here and on measured ones.
#![allow(clippy::disallowed_macros, reason = "a test shows what it measured, or that it was skipped")]

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use std::path::Path;
use switchback_identify::free::*;
use switchback_model::hysteresis::{BorderPair, Interval, SwitchedHysteresis};
use switchback_model::linear::filter;
use switchback_model::record::Record;
use switchback_model::reversal::{Branches, ReversalRule, SensorNoise, Timing};

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
const HARDENING: Pair = Pair(|v| 0.4 * v + 0.2 * v.powi(3) - 0.2, |v| 0.4 * v + 0.2 * v.powi(3) + 0.2);
const JUMP: Pair = Pair(|v| if v < 0.11 { -0.7 } else { 0.3 }, |v| if v < -0.33 { -0.2 } else { 0.9 });
const HUMP: Pair = Pair(|v| -0.5 + 0.4 * (3.0 * v).cos(), |v| 0.5 + 0.3 * (4.0 * v).sin());

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

fn operator(pair: Pair) -> SwitchedHysteresis {
    SwitchedHysteresis::new(Interval::new(-1.0, 1.0).unwrap(), Box::new(pair)).unwrap()
}

/// A record of `A y = B u + ξ` at rest before the first sample.
fn simulate(pair: Pair, a: &[f64], b: &[f64], v: &[f64], xi: &[f64]) -> Vec<f64> {
    filter(a, b, &operator(pair).output(v, 0.0), xi, 0.0, 0.0)
}

fn added(x: &[f64], e: &[f64]) -> Vec<f64> {
    x.iter().zip(e).map(|(x, e)| x + e).collect()
}

fn known(order: usize, delay: isize, knots: usize) -> Settings {
    Settings {
        order: Some(order),
        delay: Some(delay),
        knots: Some(knots),
        ..Settings::new(InputMap::Borders)
    }
}

const A: [f64; 2] = [-1.1, 0.4];
const B: [f64; 2] = [0.8, -0.3];

fn leaf_grid() -> Grid {
    Grid {
        structure: Structure { order: 2, delay: 0 },
        basis: Basis::borders(vec![-1.0, 0.0, 1.0], vec![-1.0, 0.0, 1.0]),
        rule: ReversalRule::EXACT,
    }
}

#[test]
fn one_shot_recovers_borders_on_its_grid_without_noise() {
    for seed in 0..20 {
        let v = random_levels(seed, 600);
        let y = simulate(SPRING, &A, &B, &v, &[]);
        let estimate = one_shot(&[&Record::new(v, y).unwrap()], &leaf_grid()).unwrap();
        // u_M − u_m = 0.8 − (−0.8).
        for (estimated, truth) in [(&estimate.a, A), (&estimate.b, B.map(|b| 1.6 * b))] {
            assert!(estimated.iter().zip(truth).all(|(x, y)| (x - y).abs() < 1e-9), "{estimated:?}");
        }
        for (points, border) in [(&estimate.descending, SPRING.0), (&estimate.ascending, SPRING.1)] {
            assert!(points.iter().all(|p| (p.f - border(p.v) / 1.6).abs() < 1e-9), "{points:?}");
        }
    }
}

#[test]
fn one_shot_is_unbiased_and_its_intervals_cover_under_white_equation_error() {
    let (replicates, samples) = (200, 1000);
    let mut z = vec![Vec::new(); 4 + 6];
    for seed in 0..replicates {
        let v = random_levels(seed, samples);
        let y = simulate(SPRING, &A, &B, &v, &normals(seed + 1000, samples, 0.1));
        let e = one_shot(&[&Record::new(v, y).unwrap()], &leaf_grid()).unwrap();
        assert!((e.noise_sd - 0.1).abs() < 0.015);
        let linear = (0..2).map(|i| (e.a[i] - A[i]) / e.a_se[i]);
        let gains = (0..2).map(|i| (e.b[i] - 1.6 * B[i]) / e.b_se[i]);
        let down = e.descending.iter().map(|p| (p.f - SPRING.0(p.v) / 1.6) / p.se);
        let up = e.ascending.iter().map(|p| (p.f - SPRING.1(p.v) / 1.6) / p.se);
        for (i, value) in linear.chain(gains).chain(down).chain(up).enumerate() {
            z[i].push(value);
        }
    }
    for (i, z) in z.iter().enumerate() {
        let count = z.len() as f64;
        let mean = z.iter().sum::<f64>() / count;
        let variance = z.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (count - 1.0);
        // Four Monte-Carlo standard errors, and the bias of order 1/N beside them.
        assert!(mean.abs() < 4.0 / count.sqrt() + 0.1, "parameter {i}: mean z {mean}");
        assert!(
            (variance - 1.0).abs() < 4.0 * (2.0 / count).sqrt(),
            "parameter {i}: variance of z {variance}"
        );
    }
}

#[test]
fn identify_recovers_a_system_on_a_smooth_input_without_noise() {
    let v = smooth(3000);
    let y = simulate(SPRING, &A, &B, &v, &[]);
    let record = Record::new(v, y).unwrap();
    let found = identify(&[&record], &known(2, 0, 2)).unwrap();
    assert!(
        found.model.free_run(&record).fit_percent > 99.99,
        "{}",
        found.model.free_run(&record).fit_percent
    );
    assert!(found.estimate.a.iter().zip(A).all(|(x, y)| (x - y).abs() < 1e-3), "{:?}", found.estimate.a);
    assert_eq!(found.model.rule().timing, Timing::AtSamples);
}

#[test]
fn order_delay_and_knots_left_open_predict_a_new_record_of_every_border() {
    for (pair, wanted) in [(SPRING, 97.0), (HARDENING, 96.0), (JUMP, 80.0), (HUMP, 92.0)] {
        let v = smooth(3000);
        let y = added(&simulate(pair, &A, &B, &v, &[]), &normals(5, 3000, 0.01));
        let found = identify(&[&Record::new(v, y).unwrap()], &Settings::new(InputMap::Borders)).unwrap();
        let new: Vec<f64> = smooth(5000).split_off(3000);
        let truth = Record::new(new.clone(), simulate(pair, &A, &B, &new, &[])).unwrap();
        let fit = found.model.free_run(&truth).fit_percent;
        assert!(fit > wanted, "{pair:?}: {fit}");
    }
}

#[test]
fn refinement_removes_the_bias_of_output_noise() {
    let v = random_levels(3, 4000);
    let y = added(&simulate(SPRING, &A, &B, &v, &[]), &normals(4, 4000, 0.2));
    let record = Record::new(v, y).unwrap();
    let error = |refine| {
        let found = identify(&[&record], &Settings { refine, ..known(2, 0, 2) }).unwrap();
        (found.estimate.a[0] - A[0]).abs()
    };
    assert!(error(false) > 0.1, "the equation error is no longer white: {}", error(false));
    assert!(error(true) < 0.05, "{}", error(true));
}

#[test]
fn a_model_of_the_noise_narrows_the_intervals_where_it_is_coloured_and_changes_nothing_where_it_is_white() {
    let (v, white) = (random_levels(3, 4000), normals(4, 4000, 0.2));
    let estimate = |y: Vec<f64>, order, whiten| {
        let settings = Settings { whiten, ..known(order, 0, 3) };
        identify(&[&Record::new(v.clone(), y).unwrap()], &settings).unwrap().estimate
    };
    let output_noise = added(&simulate(SPRING, &A, &B, &v, &[]), &white);
    assert_eq!(estimate(output_noise.clone(), 2, true), estimate(output_noise, 2, false));
    let equation_error = simulate(SPRING, &A, &B, &v, &white);
    let (whitened, plain) =
        (estimate(equation_error.clone(), 2, true), estimate(equation_error.clone(), 2, false));
    let narrower = plain.a_se[0] / whitened.a_se[0];
    assert!(narrower > 1.2, "{narrower}");
    for (i, truth) in A.into_iter().enumerate() {
        assert!((whitened.a[i] - truth).abs() < 4.0 * whitened.a_se[i], "{whitened:?}");
    }
    // A model of too low an order contradicts itself through another filter, and the fit without one is kept.
    assert_eq!(estimate(equation_error.clone(), 1, true), estimate(equation_error, 1, false));
}

#[test]
fn sensor_noise_on_the_input_is_found_and_does_not_fake_reversals() {
    let wave = |t: f64| 0.8 * (0.041 * t).sin() + 0.15 * (0.0093 * t + 1.0).sin();
    let clean: Vec<f64> = (0..4000).map(|t| wave(f64::from(t))).collect();
    let y = added(&simulate(SPRING, &A, &B, &clean, &[]), &normals(7, 4000, 0.01));
    let v = added(&clean, &normals(8, 4000, 0.004));
    let noise = SensorNoise::of(&v);
    assert!(noise.threshold > 0.015 && noise.threshold < 0.05, "{noise:?}");
    assert_eq!(SensorNoise::of(&clean).threshold, 0.0);
    let record = Record::new(v, y).unwrap();
    let fit = |threshold| {
        let found = identify(&[&record], &Settings { threshold, ..known(2, 0, 3) }).unwrap();
        (found.model.free_run(&record).fit_percent, found.warnings)
    };
    let (with_threshold, warnings) = fit(None);
    assert!(with_threshold > 90.0, "{with_threshold}");
    assert!(warnings.iter().any(|w| matches!(w, Warning::SensorNoise { .. })));
    let without = fit(Some(0.0)).0;
    println!("{with_threshold:.1} % with, {without:.1} % without a threshold");
    assert!(without < with_threshold - 5.0);
}

#[test]
fn motion_is_not_taken_for_noise() {
    let mut walk = normals(1, 3000, 0.1);
    for t in 1..walk.len() {
        walk[t] += walk[t - 1];
    }
    let steps: Vec<f64> = (0..2000).map(|t| if t % 20 < 10 { 0.0 } else { 1.0 }).collect();
    let pulses: Vec<f64> =
        (0..2000).map(|t| if t % 2 == 0 { 1.0 } else { f64::from(t % 10) / 10.0 }).collect();
    for v in [random_levels(2, 2000), walk, steps, pulses] {
        assert_eq!(SensorNoise::of(&v).threshold, 0.0);
    }
}

#[test]
fn a_noisy_rest_at_an_extremum_stays_on_its_border() {
    // Up, rest for 50 samples, down, rest, up again.
    let ramp = |from: f64, to: f64| (0..100).map(move |t| from + (to - from) * f64::from(t) / 100.0);
    let clean: Vec<f64> = ramp(0.0, 1.0)
        .chain([1.0; 50])
        .chain(ramp(1.0, 0.0))
        .chain([0.0; 50])
        .chain(ramp(0.0, 1.0))
        .collect();
    let exact = Branches::of(&clean, ReversalRule::EXACT).unwrap();
    let noisy = added(&clean, &normals(3, clean.len(), 0.002));
    let rule = ReversalRule { threshold: 0.012, band: 0.006, timing: Timing::AtSamples };
    let branches = Branches::of(&noisy, rule).unwrap();
    assert_eq!(branches.reversals(), 2);
    let differ = exact.labels().iter().zip(branches.labels()).filter(|(x, y)| x != y).count();
    assert!(differ <= 4, "{differ} samples on the wrong border");
}

#[test]
fn the_exact_rule_is_the_operator_s() {
    let v = random_levels(9, 500);
    let u = operator(JUMP).output(&v, 0.0);
    let branches = Branches::of(&v, ReversalRule::EXACT).unwrap();
    for t in branches.first_known()..v.len() {
        assert_eq!(u[t], operator(JUMP).border(branches.labels()[t], v[t]));
    }
}

#[test]
fn weak_points_are_reported() {
    let v = smooth(3000);
    let y = simulate(JUMP, &A, &B, &v, &[]);
    let found = identify(&[&Record::new(v, y).unwrap()], &known(2, 0, 10)).unwrap();
    assert!(found.warnings.iter().any(|w| matches!(w, Warning::SteepCell { .. })), "{:?}", found.warnings);
    let slope: Vec<f64> = (0..400).map(|t| f64::from(t) / 200.0 - 1.0).collect();
    let y = simulate(SPRING, &A, &B, &[&slope[..], &slope[..]].concat(), &[]);
    let found =
        identify(&[&Record::new([&slope[..], &slope[..]].concat(), y).unwrap()], &known(1, 0, 3)).unwrap();
    assert!(
        found.warnings.iter().any(|w| matches!(w, Warning::FewReversals { count: 2 })),
        "{:?}",
        found.warnings
    );
}

#[test]
fn what_cannot_be_identified_is_refused() {
    let settings = Settings::new(InputMap::Borders);
    assert_eq!(identify(&[], &settings).unwrap_err(), FreeError::NoRecords);
    let still = Record::new(vec![1.0; 50], random_levels(1, 50)).unwrap();
    assert_eq!(identify(&[&still], &settings).unwrap_err(), FreeError::NoMotion { threshold: 0.0 });
    let flat = Record::new(random_levels(1, 50), vec![1.0; 50]).unwrap();
    assert_eq!(identify(&[&flat], &settings).unwrap_err(), FreeError::ConstantOutput);
    let short = Record::new(random_levels(1, 20), random_levels(2, 20)).unwrap();
    assert!(matches!(identify(&[&short], &known(2, 0, 5)), Err(FreeError::TooShort { .. })));
    assert!(matches!(identify(&[&short], &settings), Err(FreeError::TooShort { .. })));
    let negative = Settings { threshold: Some(-1.0), ..settings };
    assert!(matches!(identify(&[&still], &negative), Err(FreeError::Setting { name: "threshold", .. })));
    let order = Settings { order: Some(0), ..settings };
    assert!(matches!(identify(&[&still], &order), Err(FreeError::Setting { name: "order", .. })));
    let far = Grid { basis: Basis::borders(vec![-1.0, 5.0, 6.0], vec![-1.0, 1.0]), ..leaf_grid() };
    let record = Record::new(random_levels(1, 200), random_levels(2, 200)).unwrap();
    assert_eq!(
        one_shot(&[&record], &far).unwrap_err(),
        FreeError::UnvisitedKnot { curve: "descending", v: 6.0 }
    );
}

/// Reads `t,v,y`.
fn measured(file: &str) -> Record {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/rigs").join(file);
    let mut reader = csv::Reader::from_path(path).expect("a measured rig beside the workspace");
    let rows: Vec<(f64, f64, f64)> = reader.deserialize().collect::<Result<_, _>>().expect("numbers");
    Record::new(rows.iter().map(|r| r.1).collect(), rows.iter().map(|r| r.2).collect()).expect("a record")
}

#[test]
#[ignore = "reads shared/rigs beside the workspace"]
fn on_measured_friction_two_borders_beat_a_line_and_a_curve_on_the_held_out_record() {
    for (fit, holdout, wanted) in [
        ("mr-damper/sweep_up.csv", "mr-damper/sweep_down.csv", 84.0),
        ("pneumatic-seal/first.csv", "pneumatic-seal/second.csv", 94.0),
    ] {
        let (fit, holdout) = (measured(fit), measured(holdout));
        let score =
            |map| identify(&[&fit], &Settings::new(map)).unwrap().model.free_run(&holdout).fit_percent;
        let [line, curve, borders] = [InputMap::Linear, InputMap::Static, InputMap::Borders].map(score);
        println!("line {line:.1} %, curve {curve:.1} %, borders {borders:.1} %");
        assert!(borders > wanted && borders > curve && borders > line);
    }
}
