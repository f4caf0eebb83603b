//! Zero and unit of input and output are matters of the sensors: every method of `identify` gives the same system by others.

use proptest::prelude::*;
use std::path::Path;
use switchback_io::identification::{Identification, Method, identify};
use switchback_model::Record;
use switchback_model::hysteresis::Interval;
use switchback_model::rig::{Rig, RigRecord};

/// `signal′ = origin + scale·signal`.
#[derive(Debug, Clone, Copy)]
struct Units {
    origin: f64,
    scale: f64,
}

impl Units {
    fn level(self, x: f64) -> f64 {
        self.origin + self.scale * x
    }

    fn of(self, signal: &[f64]) -> Vec<f64> {
        signal.iter().map(|x| self.level(*x)).collect()
    }

    /// Size of what is rounded.
    fn size(self, x: f64) -> f64 {
        self.origin.abs() + self.scale * x.abs()
    }
}

fn leaf_spring() -> Rig {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/rigs/leaf-spring/rig.toml");
    switchback_io::rig::read(&path).expect("the rig in the repository")
}

/// The same records by other sensors.
fn seen(rig: &Rig, (of_v, of_y): (Units, Units)) -> Rig {
    let other = |r: &RigRecord| RigRecord {
        record: Record::new(of_v.of(r.record.v()), of_y.of(r.record.y())).expect("finite and equally long"),
        ..r.clone()
    };
    let interval = rig.interval.map(|interval| {
        Interval::new(of_v.level(interval.low()), of_v.level(interval.high())).expect("an interval")
    });
    Rig { interval, records: rig.records.iter().map(other).collect(), ..rig.clone() }
}

/// To rounding: 1e-9 of the size of what is compared.
#[track_caller]
fn agree(what: &str, found: f64, expected: f64, size: f64) {
    let off = (found - expected).abs();
    assert!(off <= 1e-9 * size, "{what}: {found:e} for {expected:e}, off by {:e}", off / size);
}

fn same(there: &Identification, here: &Identification, (of_v, of_y): (Units, Units)) {
    let (one, other) = (&here.estimate, &there.estimate);
    for (what, found, expected, factor) in [
        ("a", &other.a, &one.a, 1.0),
        ("error of a", &other.a_se, &one.a_se, 1.0),
        ("b", &other.b, &one.b, of_y.scale),
        ("error of b", &other.b_se, &one.b_se, of_y.scale),
    ] {
        let size = factor * expected.iter().map(|x| x.abs()).fold(0.0, f64::max);
        assert_eq!(found.len(), expected.len());
        found.iter().zip(expected).for_each(|(x, e)| agree(what, *x, factor * e, size));
    }
    agree("noise", other.noise_sd, of_y.scale * one.noise_sd, of_y.scale * one.noise_sd);
    agree("gain", other.gain, of_y.scale * one.gain, of_y.scale * one.gain.abs());
    agree("y_high", other.y_high, of_y.level(one.y_high), of_y.size(one.y_high));
    agree("y_low", other.y_low, of_y.level(one.y_low), of_y.size(one.y_low));
    for (points, expected) in [(&other.descending, &one.descending), (&other.ascending, &one.ascending)] {
        assert_eq!(points.len(), expected.len());
        for (point, expected) in points.iter().zip(expected) {
            agree("a level", point.v, of_v.level(expected.v), of_v.size(expected.v));
            let holds = one.gain * expected.f;
            agree("a border", other.gain * point.f, of_y.level(holds), of_y.size(holds));
            if of_y.origin == 0.0 && expected.se.is_finite() {
                agree("error of a border", point.se, expected.se, expected.se.max(1e-9));
            }
        }
    }
    for (run, expected) in there.runs.iter().zip(&here.runs) {
        assert_eq!(run.is_some(), expected.is_some());
        if let (Some(run), Some(expected)) = (run, expected) {
            agree("fit", run.fit_percent, expected.fit_percent, 100.0);
        }
    }
}

fn units() -> impl Strategy<Value = Units> {
    let size = (-6.0..6.0f64).prop_map(|x| 10f64.powf(x));
    // An origin so many spreads away costs as many of the digits that the signal is given with.
    (size, prop_oneof![Just(0.0), -100.0..100.0f64])
        .prop_map(|(scale, origin)| Units { origin: origin * scale, scale })
}

proptest! {
    #![proptest_config(ProptestConfig { max_shrink_iters: 0, ..ProptestConfig::with_cases(3) })]

    #[test]
    fn every_method_gives_the_same_system_by_other_sensors(v in units(), y in units()) {
        let rig = leaf_spring();
        for method in Method::ALL {
            let here = identify(&rig, method).expect("identified");
            let there = identify(&seen(&rig, (v, y)), method).expect("identified");
            println!("{method}");
            same(&there, &here, (v, y));
        }
    }
}
