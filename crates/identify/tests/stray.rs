//! One sample that no measurement can be moves nothing but a warning.

use crate::structure::{first_order, walk};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use switchback_identify::free::{Identified, InputMap, Settings, Warning, identify};
use switchback_model::Record;
use switchback_model::stray::SignalName;

const SAMPLES: usize = 2000;

fn identified(v: &[f64], y: &[f64]) -> Identified {
    let record = Record::new(v.to_vec(), y.to_vec()).expect("a record");
    let settings = Settings { input_noise: false, ..Settings::new(InputMap::Borders) };
    identify(&[&record], &settings).expect("a model")
}

/// The largest move of a coefficient or of a border point, in standard errors.
fn largest_move(from: &Identified, to: &Identified) -> f64 {
    let (x, y) = (&from.estimate, &to.estimate);
    assert_eq!((x.a.len(), x.b.len(), x.delay), (y.a.len(), y.b.len(), y.delay));
    let coefficients = x.a.iter().zip(&y.a).zip(&x.a_se).chain(x.b.iter().zip(&y.b).zip(&x.b_se));
    let coefficients = coefficients.map(|((x, y), se)| (x - y).abs() / se);
    let points = x.descending.iter().zip(&y.descending).chain(x.ascending.iter().zip(&y.ascending));
    let points = points.filter(|(x, _)| x.se > 0.0).map(|(x, y)| (x.f - y.f).abs() / x.se);
    coefficients.chain(points).fold(0.0, f64::max)
}

/// Puts a bad sample of some sizes at random places of either signal.
fn check(places: usize) {
    let v = walk(5, SAMPLES);
    let y = first_order(&v, 6, 0.02);
    let clean = identified(&v, &y);
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    for place in 0..places {
        let sample = rng.random_range(0..SAMPLES);
        let signal = if place % 2 == 0 { SignalName::Output } else { SignalName::Input };
        for times in [10.0, 1e3, 1e6] {
            let (mut v, mut y) = (v.clone(), y.clone());
            let values = if signal == SignalName::Output { &mut y } else { &mut v };
            let (low, high) = values.iter().fold((0.0_f64, 0.0_f64), |(l, h), x| (l.min(*x), h.max(*x)));
            values[sample] += times * (high - low);
            let found = identified(&v, &y);
            let moved = largest_move(&clean, &found);
            assert!(moved <= 1.0, "sample {sample} of {signal:?}, times {times}: {moved} standard errors");
            let names = |w: &Warning| matches!(w, Warning::StraySamples { first, count: 1 } if (first.sample, first.signal) == (sample, signal));
            assert!(found.warnings.iter().any(names), "{:?}", found.warnings);
        }
    }
}

#[test]
fn one_bad_sample_moves_no_estimate_by_its_error() {
    check(4);
}

#[test]
#[ignore = "three hundred identifications"]
fn one_bad_sample_at_a_hundred_places_moves_no_estimate_by_its_error() {
    check(100);
}
