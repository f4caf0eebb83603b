//! Eight replicates abreast against the methods one replicate at a time.

use proptest::prelude::*;
use switchback_estimator::estimators::pulse::lanes::{LANES, Lane, LaneFit, LaneMethod, LaneStep};
use switchback_estimator::estimators::pulse::{Limit, PulseData, PulseMethod, StepMean};
use switchback_estimator::excitation::{Direction, PulseExperiment};
use switchback_estimator::hysteresis::{Interval, LeafSpring, SwitchedHysteresis};
use switchback_estimator::linear::{LinearSystem, filter};
use switchback_estimator::simulation::{
    LaneMoments, LaneSuperposition, NoiseMoments, PeriodicDesign, periodic_response, superpose,
};

const BOTH: [Direction; 2] = [Direction::Descendant, Direction::Ascendant];

/// A system of order `n` with real poles apart from each other, and the order that the regression assumes.
fn systems() -> impl Strategy<Value = (LinearSystem, usize)> {
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
fn noise(seed: u64, count: usize) -> Vec<f64> {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    let mut uniform = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..count).map(|_| (0..12).map(|_| uniform()).sum::<f64>() - 6.0).collect()
}

struct Bench {
    designs: [PeriodicDesign; 2],
    responses: [Vec<f64>; 2],
    system: LinearSystem,
    order: usize,
    samples: usize,
}

impl Bench {
    fn new(system: LinearSystem, order: usize, friction: f64, points: usize, samples: usize) -> Self {
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

    fn moments(&self, seed: u64) -> NoiseMoments {
        let w = noise(seed, 200 + self.order + self.samples);
        let e = filter(self.system.a(), &[], &w, &w, 0.0, 0.0).split_off(200);
        NoiseMoments::from_samples(&e, self.order, self.designs[0].period())
    }

    fn step(&self, k: usize, sigma: f64, noise: f64) -> StepMean {
        let u = [self.designs[0].u[0], self.designs[1].u[0]][k];
        StepMean { mean: self.system.static_gain() * u + sigma * noise, samples: self.samples as f64 }
    }
}

/// Every method on both experiments.
fn methods<'a>(
    both: &'a [&'a PulseData; 2],
    steps: [StepMean; 2],
) -> [(PulseMethod<'a>, &'static [usize]); 6] {
    [
        (PulseMethod::Paper { experiment: both[0], step: steps[0] }, &[0]),
        (PulseMethod::Paper { experiment: both[1], step: steps[1] }, &[1]),
        (PulseMethod::Joint { descendant: both[0], ascendant: both[1] }, &[0, 1]),
        (PulseMethod::Efficient(both), &[0, 1]),
        (PulseMethod::LinearArx(both), &[0, 1]),
        (PulseMethod::Memoryless(both), &[0, 1]),
    ]
}

fn step_of(method: &PulseMethod<'_>) -> Option<StepMean> {
    match method {
        PulseMethod::Paper { step, .. } => Some(*step),
        _ => None,
    }
}

fn near(what: &str, fast: f64, slow: f64, scale: f64) -> Result<(), TestCaseError> {
    prop_assert!((fast - slow).abs() < 1e-9 * scale, "{}: {} against {}", what, fast, slow);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn lanes_give_what_every_replicate_gives_by_itself(
        (system, order) in systems(), friction in 0.1..1.0_f64, points in 1..=9_usize, sigma in 0.02..0.5_f64, samples in 0..60_usize, seed in 0..1000_u64,
    ) {
        let bench = Bench::new(system, order, friction, points, samples);
        let moments: Vec<[NoiseMoments; 2]> =
            (0..LANES as u64).map(|l| [0, 1].map(|k| bench.moments(seed * 100 + 2 * l + k))).collect();
        let step_noise = noise(seed, LANES).iter().map(|x| x / (bench.samples as f64).sqrt()).collect::<Vec<_>>();
        let lanes: [_; 2] = std::array::from_fn(|k| {
            let mut all = LaneMoments::zeros(order, bench.designs[k].period());
            moments.iter().enumerate().for_each(|(l, m)| all.set(l, &m[k]));
            let mut superposition = LaneSuperposition::new(&bench.designs[k], &bench.responses[k], bench.samples);
            superposition.load(&all);
            let mut statistics = superposition.statistics();
            superposition.at(sigma, &mut statistics);
            statistics
        });
        let expected: [PulseData; 2] = std::array::from_fn(|k| {
            let m = NoiseMoments::expected(bench.system.a(), &[], order, bench.designs[k].period(), 1e9);
            superpose(&bench.designs[k], &bench.responses[k], sigma, &m)
        });
        let expected = [&expected[0], &expected[1]];
        let endless = [0, 1].map(|k| StepMean { samples: 1e9, ..bench.step(k, sigma, 0.0) });
        let (mut fit, mut score, mut first) = (LaneFit::default(), Vec::new(), Vec::new());
        for (m, (example, experiments)) in methods(&expected, endless).into_iter().enumerate() {
            let method = LaneMethod::of(&example);
            let parts: Vec<_> = experiments.iter().map(|k| &lanes[*k]).collect();
            let step = step_of(&example).map(|_| LaneStep {
                mean: Lane(std::array::from_fn(|l| bench.step(experiments[0], sigma, step_noise[l]).mean)),
                samples: bench.samples as f64,
            });
            method.fit(&parts, step, &mut fit);
            let limit = Limit::of(example).ok();
            if let Some(limit) = &limit {
                limit.lanes().first_order(&parts, step.map(|s| s.mean), &mut score, &mut first);
            }
            for l in 0..LANES {
                let data: [PulseData; 2] =
                    std::array::from_fn(|k| superpose(&bench.designs[k], &bench.responses[k], sigma, &moments[l][k]));
                let both = [&data[0], &data[1]];
                let steps = [0, 1].map(|k| bench.step(k, sigma, step_noise[l]));
                let slow_method = methods(&both, steps)[m].0;
                let Ok(slow) = slow_method.fit() else { continue };
                prop_assert!(fit.sound[l], "method {} has an estimate", m);
                let scale = slow.parameters().fold(1.0_f64, |s, p| s.max(p.value.abs()));
                for (k, p) in slow.parameters().enumerate() {
                    near(&format!("method {m}, parameter {k}"), fit.values[k].0[l], p.value, scale)?;
                    near(&format!("method {m}, se {k}"), fit.variances[k].0[l].sqrt(), p.se, scale)?;
                }
                if let Some(limit) = &limit {
                    for (k, slow) in limit.first_order(&slow_method).into_iter().enumerate() {
                        near(&format!("method {m}, first-order {k}"), first[k].0[l], slow, scale)?;
                    }
                }
            }
        }
    }
}
