//! Zero and unit of input and output are matters of the sensors: no answer depends on them.

use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use switchback_identify::free::{Identified, InputMap, Settings, identify};
use switchback_model::Record;

/// `signal′ = origin + scale·signal`.
#[derive(Debug, Clone, Copy)]
struct Units {
    origin: f64,
    scale: f64,
}

impl Units {
    fn of(self, signal: &[f64]) -> Vec<f64> {
        signal.iter().map(|x| self.level(*x)).collect()
    }

    fn level(self, x: f64) -> f64 {
        self.origin + self.scale * x
    }

    /// Size of what is rounded.
    fn size(self, x: f64) -> f64 {
        self.origin.abs() + self.scale * x.abs()
    }
}

/// A loop of two borders before two poles, noise in the equation, the input a walk between random levels.
fn measured(seed: u64) -> (Vec<f64>, Vec<f64>) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let (mut v, mut y) = (vec![0.0], vec![0.0, 0.0]);
    while v.len() < 500 {
        let (from, to) = (v[v.len() - 1], rng.random_range(-1.0..1.0));
        let steps = rng.random_range(3..12);
        v.extend((1..=steps).map(|k| from + (to - from) * f64::from(k) / f64::from(steps)));
    }
    for t in 2..v.len() {
        let u = v[t - 1] + 0.3 * (v[t - 1] - v[t - 2]).signum() + 0.2 * v[t - 1].powi(2);
        y.push(1.2 * y[t - 1] - 0.45 * y[t - 2] + 0.3 * u + 0.02 * rng.random_range(-1.0..1.0));
    }
    (v, y)
}

fn identified(v: &[f64], y: &[f64], map: InputMap) -> Identified {
    let record = Record::new(v.to_vec(), y.to_vec()).unwrap();
    // What is nearly open, as coefficients that look ahead are here, is reported to fewer digits.
    let settings = Settings { order: Some(2), delay: Some(0), ..Settings::new(map) };
    identify(&[&record], &settings).unwrap()
}

/// To rounding: 1e-9 of the size of what is compared.
const ROUNDING: f64 = 1e-9;

/// The same of standard errors: entries of the inverse of a normal matrix, whose condition number, 1e8 in records like these, multiplies the
/// rounding of its own entries, 1e-16. Estimates gain from the residuals being small; errors do not.
const ROUNDING_OF_ERRORS: f64 = 1e-7;

#[track_caller]
fn agree(what: &str, found: f64, expected: f64, size: f64) {
    let off = (found - expected).abs();
    let rounding = if what.contains("error") { ROUNDING_OF_ERRORS } else { ROUNDING };
    assert!(off <= rounding * size, "{what}: {found:e} for {expected:e}, off by {:e}", off / size);
}

fn check(seed: u64, map: InputMap, (of_v, of_y): (Units, Units)) {
    let (v, y) = measured(seed);
    let here = identified(&v, &y, map);
    let there = identified(&of_v.of(&v), &of_y.of(&y), map);
    assert_eq!(here.selection.structure, there.selection.structure);
    let (one, other) = (&here.estimate, &there.estimate);
    for (what, found, expected, factor) in [
        ("a", &other.a, &one.a, 1.0),
        ("error of a", &other.a_se, &one.a_se, 1.0),
        ("b", &other.b, &one.b, of_y.scale),
        ("error of b", &other.b_se, &one.b_se, of_y.scale),
    ] {
        let size = factor * expected.iter().map(|x| x.abs()).fold(0.0, f64::max);
        found.iter().zip(expected).for_each(|(x, e)| agree(what, *x, factor * e, size));
    }
    let (errors, other_errors) = (here.level_errors.unwrap(), there.level_errors.unwrap());
    for (what, found, expected) in [
        ("noise", other.noise_sd, one.noise_sd),
        ("gain", other.gain, one.gain),
        ("error of the gain", other_errors.gain, errors.gain),
        ("error of y_high", other_errors.y_high, errors.y_high),
        ("error of y_low", other_errors.y_low, errors.y_low),
    ] {
        agree(what, found, of_y.scale * expected, of_y.scale * expected.abs());
    }
    agree("excitation", other.excitation, one.excitation, one.excitation);
    agree("y_high", other.y_high, of_y.level(one.y_high), of_y.size(one.y_high));
    agree("y_low", other.y_low, of_y.level(one.y_low), of_y.size(one.y_low));
    for (points, expected) in [(&other.descending, &one.descending), (&other.ascending, &one.ascending)] {
        assert_eq!(points.len(), expected.len());
        for (point, expected) in points.iter().zip(expected) {
            agree("a knot", point.v, of_v.level(expected.v), of_v.size(expected.v));
            // The output that the border holds.
            let holds = one.gain * expected.f;
            agree("a border", other.gain * point.f, of_y.level(holds), of_y.size(holds));
            if of_y.origin == 0.0 {
                agree("error of a border", point.se, expected.se, expected.se);
            }
        }
    }
    if let (Some(found), Some(expected)) = (there.distance, here.distance) {
        agree("distance", found.z, expected.z, expected.z);
        agree("its error", found.clearest.se, expected.clearest.se, expected.clearest.se);
    }
    let (run, expected) = (there.model.simulate(&of_v.of(&v), &[]), here.model.simulate(&v, &[]));
    for (y, expected) in run.iter().zip(&expected) {
        agree("a free run", *y, of_y.level(*expected), of_y.size(1.0));
    }
}

fn units() -> impl Strategy<Value = Units> {
    let size = || (-6.0..6.0f64).prop_map(|x| 10f64.powf(x));
    // An origin so many spreads away costs as many of the digits that the signal is given with.
    (size(), prop_oneof![Just(0.0), -1e3..1e3f64])
        .prop_map(|(scale, origin)| Units { origin: origin * scale, scale })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    #[test]
    fn no_answer_of_the_borders_depends_on_zero_or_unit(seed: u64, v in units(), y in units()) {
        check(seed, InputMap::Borders, (v, y));
    }

    #[test]
    fn no_answer_of_the_static_curve_depends_on_zero_or_unit(seed: u64, v in units(), y in units()) {
        check(seed, InputMap::Static, (v, y));
    }

    #[test]
    fn no_answer_of_the_straight_line_depends_on_zero_or_unit(seed: u64, v in units(), y in units()) {
        check(seed, InputMap::Linear, (v, y));
    }
}

#[test]
fn outputs_a_hundred_thousand_spreads_from_zero_give_the_same_dynamics() {
    for map in [InputMap::Borders, InputMap::Static, InputMap::Linear] {
        let (v, y) = measured(5);
        let here = identified(&v, &y, map).estimate;
        let there = identified(&v, &Units { origin: 1e5, scale: 1.0 }.of(&y), map).estimate;
        for (a, (found, se)) in here.a.iter().zip(there.a.iter().zip(&there.a_se)) {
            agree("a", *found, *a, 1.0);
            assert!(*se < 0.1, "{map:?}: {found} ± {se}");
        }
    }
}
