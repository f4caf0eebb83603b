//! What the choice between two fits does to the intervals of `identify`: how often they hold the truth where the noise's colour is modelled if that
//! contradicts no fit without (the default), and where it never is.
//!
//! The choice looks at the data, so that the intervals of what was chosen could be too narrow (H. Leeb, B. M. Pötscher, Econometric Theory 21
//! (2005), 21–59). Records of a spring with curved borders on a smooth motion, order and delay given, knots left to the data.
//!
//! `cargo run -p switchback-identify --example noise_pretest -- RECORDS`

#![allow(
    clippy::disallowed_macros,
    clippy::disallowed_methods,
    reason = "an example prints, and takes an argument"
)]

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use std::error::Error;
use switchback_identify::Estimate;
use switchback_identify::free::{InputMap, Settings, identify};
use switchback_identify::statistics::normal_quantile_975;
use switchback_model::Record;
use switchback_model::hysteresis::{Branch, Interval, LeafSpring, SwitchedHysteresis};
use switchback_model::linear::filter;

const A: [f64; 2] = [-1.2, 0.45];
const B: [f64; 2] = [0.15, 0.10];
const SAMPLES: usize = 4_000;

/// How white noise `w` enters `A y = B u + ξ`.
const NOISES: [(&str, f64, Noise); 4] = [
    ("white equation error", 0.05, |w| w.to_vec()),
    ("coloured equation error", 0.05, |w| filter(&[-0.8], &[], w, w, 0.0, 0.0)),
    // ξ = A w.
    ("white output noise", 0.1, |w| filter(&[], &A, w, w, 0.0, 0.0)),
    // ξ = A w/D.
    ("coloured output noise", 0.1, |w| {
        let coloured = filter(&[-0.7], &[], w, w, 0.0, 0.0);
        filter(&[], &A, &coloured, &coloured, 0.0, 0.0)
    }),
];

type Noise = fn(&[f64]) -> Vec<f64>;

fn main() -> Result<(), Box<dyn Error>> {
    let records: u64 = std::env::args().nth(1).map_or(Ok(100), |text| text.parse())?;
    println!(
        "coverage of nominal 95 % intervals, {records} records of {SAMPLES} samples: a, b, border points"
    );
    for (name, sd, noise) in NOISES {
        for whiten in [true, false] {
            let settings =
                Settings { order: Some(2), delay: Some(0), whiten, ..Settings::new(InputMap::Borders) };
            let mut held = [[0_u32; 2]; 3];
            for seed in 0..records {
                let (record, spring) = made(seed, (sd, noise))?;
                add(&identify(&[&record], &settings)?.estimate, &spring, &mut held);
            }
            let chosen = if whiten { "colour modelled unless contradicted" } else { "colour never modelled" };
            let [a, b, borders] = held.map(|[held, all]| 100.0 * f64::from(held) / f64::from(all));
            println!("{name:24} {chosen:36} {a:5.1} {b:5.1} {borders:5.1} %");
        }
    }
    Ok(())
}

/// A record with its spring.
fn made(seed: u64, (sd, noise): (f64, Noise)) -> Result<(Record, SwitchedHysteresis), Box<dyn Error>> {
    let wave = |t: f64| 22.0 * (0.041 * t).sin() + 10.0 * (0.0931 * t + 1.0).sin() + 8.0 * (0.017 * t).cos();
    let v: Vec<f64> = (0..SAMPLES).map(|t| wave(t as f64)).collect();
    let (low, high) = v.iter().fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(*x), h.max(*x)));
    let interval = Interval::new(low, high)?;
    let spring = SwitchedHysteresis::new(interval, Box::new(LeafSpring::hardening(0.12, 6e-5, 2.0)?))?;
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let white: Vec<f64> =
        (0..SAMPLES).map(|_| sd * Distribution::<f64>::sample(&StandardNormal, &mut random)).collect();
    let y = filter(&A, &B, &spring.output(&v, 0.0), &noise(&white), 0.0, 0.0);
    Ok((Record::new(v, y)?, spring))
}

/// Counts, for `a`, `b` and the border points, the intervals that hold the truth, and all.
fn add(estimate: &Estimate, spring: &SwitchedHysteresis, held: &mut [[u32; 2]; 3]) {
    let span = spring.span();
    let mut count = |group: usize, value: f64, se: f64, truth: f64| {
        held[group][0] += u32::from((value - truth).abs() <= normal_quantile_975() * se);
        held[group][1] += 1;
    };
    for (k, (value, se)) in estimate.a.iter().zip(&estimate.a_se).enumerate() {
        count(0, *value, *se, A[k]);
    }
    for (k, (value, se)) in estimate.b.iter().zip(&estimate.b_se).enumerate() {
        count(1, *value, *se, B[k] * span);
    }
    for (points, branch) in
        [(&estimate.descending, Branch::Descending), (&estimate.ascending, Branch::Ascending)]
    {
        points.iter().for_each(|point| count(2, point.f, point.se, spring.border(branch, point.v) / span));
    }
}
