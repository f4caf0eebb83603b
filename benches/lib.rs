//! Systems, experiments and seeds the benches share.

use std::time::Duration;

use criterion::Criterion;
use switchback_identify::excitation::{Direction, PulseExperiment};
use switchback_model::hysteresis::{Interval, LeafSpring, SwitchedHysteresis};
use switchback_model::linear::LinearSystem;
use switchback_noise::{NoisePlan, StreamId, samples};

/// Enough runs for a steady median, few enough that all benches end in a minute or two.
pub fn settings() -> Criterion {
    Criterion::default()
        .sample_size(30)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(2))
}

/// The leaf spring's second-order system.
pub fn system() -> LinearSystem {
    LinearSystem::new(vec![-1.2, 0.45], vec![0.15, 0.10]).expect("a valid system")
}

/// A leaf spring with hardening stiffness on `[−1, 1]`.
pub fn spring() -> SwitchedHysteresis {
    let interval = Interval::new(-1.0, 1.0).expect("an interval");
    let borders = LeafSpring::hardening(0.6, 0.4, 0.3).expect("borders");
    SwitchedHysteresis::new(interval, Box::new(borders)).expect("Assumption 1 holds")
}

/// The experiment of that direction with `points` evenly spaced levels.
pub fn experiment(direction: Direction, points: usize) -> PulseExperiment {
    PulseExperiment::evenly_spaced(spring().interval(), direction, points, 2).expect("a valid experiment")
}

/// Output noise of the equation error: `count` samples of `w/A` from its stationary state.
pub fn noise(replicate: u32, count: usize) -> Vec<f64> {
    let plan = NoisePlan {
        ar: system().a().to_vec(),
        ma: vec![],
        lags: 2,
        periods: vec![],
        checkpoints: vec![count],
        burn_in: 200,
    };
    let stream = StreamId { seed: 1, experiment: 0, replicate };
    samples(&plan, stream, count).expect("the plan is valid").e.split_off(plan.burn_in)
}
