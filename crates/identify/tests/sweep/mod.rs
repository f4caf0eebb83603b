//! Random cells of a sweep, and every method on them.

use proptest::prelude::*;
use switchback_identify::excitation::{Direction, PulseExperiment};
use switchback_identify::pulse::{PulseData, PulseMethod, StepMean};
use switchback_identify::simulation::{NoiseMoments, PeriodicDesign, periodic_response};
use switchback_model::hysteresis::{Interval, LeafSpring, SwitchedHysteresis};
use switchback_model::linear::{LinearSystem, filter};

const BOTH: [Direction; 2] = [Direction::Descendant, Direction::Ascendant];

/// A system of order `n` with real poles apart from each other, and the order that the regression assumes.
pub(crate) fn systems() -> impl Strategy<Value = (LinearSystem, usize)> {
    (1..=3_usize, 0..=1_usize)
        .prop_flat_map(|(n, more)| (prop::collection::vec(0.2..1.0_f64, n), -0.7..0.2_f64, Just(n + more)))
        .prop_filter_map("coprime", |(b, first, order)| {
            let mut c = vec![1.0];
            for k in 0..b.len() {
                let p = first + 0.25 * k as f64;
                c.push(0.0);
                for i in (1..c.len()).rev() {
                    c[i] -= p * c[i - 1];
                }
            }
            Some((LinearSystem::new(c.split_off(1), b).ok()?, order))
        })
}

/// Roughly Gaussian numbers of a replicate.
pub(crate) fn noise(seed: u64, count: usize) -> Vec<f64> {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    let mut uniform = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..count).map(|_| (0..12).map(|_| uniform()).sum::<f64>() - 6.0).collect()
}

pub(crate) struct Setup {
    pub(crate) designs: [PeriodicDesign; 2],
    pub(crate) responses: [Vec<f64>; 2],
    pub(crate) system: LinearSystem,
    pub(crate) order: usize,
    pub(crate) samples: usize,
}

impl Setup {
    pub(crate) fn new(
        system: LinearSystem,
        order: usize,
        friction: f64,
        points: usize,
        samples: usize,
    ) -> Self {
        let interval = Interval::new(-2.0, 3.0).expect("an interval");
        let spring = LeafSpring::hardening(0.4, 0.1, friction).expect("a leaf spring");
        let hysteresis = SwitchedHysteresis::new(interval, Box::new(spring)).expect("Assumption 1");
        let designs = BOTH.map(|direction| {
            let experiment =
                PulseExperiment::evenly_spaced(interval, direction, points, order).expect("levels");
            PeriodicDesign::new(&experiment, &hysteresis, order)
        });
        let responses = [0, 1].map(|k| periodic_response(&system, &designs[k].u));
        let samples = samples + 12 * designs[0].period();
        Self { designs, responses, system, order, samples }
    }

    pub(crate) fn moments(&self, seed: u64) -> NoiseMoments {
        let w = noise(seed, 200 + self.order + self.samples);
        let e = filter(self.system.a(), &[], &w, &w, 0.0, 0.0).split_off(200);
        NoiseMoments::from_samples(&e, self.order, self.designs[0].period())
    }

    pub(crate) fn step(&self, k: usize, sigma: f64, noise: f64) -> StepMean {
        let u = [self.designs[0].u[0], self.designs[1].u[0]][k];
        StepMean { mean: self.system.static_gain() * u + sigma * noise, samples: self.samples as f64 }
    }
}

/// Every method on both experiments.
pub(crate) fn methods<'a>(
    both: &'a [&'a PulseData; 2],
    steps: [StepMean; 2],
) -> [(PulseMethod<'a>, &'static [usize]); 7] {
    [
        (PulseMethod::Paper { experiment: both[0], step: steps[0] }, &[0]),
        (PulseMethod::Paper { experiment: both[1], step: steps[1] }, &[1]),
        (PulseMethod::Joint { descendant: both[0], ascendant: both[1] }, &[0, 1]),
        (PulseMethod::Efficient(both), &[0, 1]),
        (PulseMethod::LinearArx(both), &[0, 1]),
        (PulseMethod::Memoryless(both), &[0, 1]),
        (PulseMethod::Instrumental(both), &[0, 1]),
    ]
}
