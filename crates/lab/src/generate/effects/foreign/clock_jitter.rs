//! `clock_jitter`: samples are taken a little early or late.

use crate::generate::effects::card;
use crate::generate::law::{Law, Nature, Scene};
use rand_distr::{Distribution, StandardNormal};

pub(super) static LAWS: [&dyn Law; 1] = [&UnsteadyClock];

/// `y' = y + x·w·(y(t) − y(t−1))`, `w` white of unit variance: noise that grows with the output's speed.
#[derive(Debug)]
struct UnsteadyClock;

impl Law for UnsteadyClock {
    card!("clock_jitter", "unsteady clock", Sensor, "samples", 3.0);

    fn nature(&self) -> Nature {
        Nature::Noise
    }

    fn sensor(&self, scene: &mut Scene<'_>, y: &mut [f64]) {
        let mut before = y[0];
        for now in y {
            let speed = *now - before;
            before = *now;
            let normal: f64 = StandardNormal.sample(&mut scene.rng);
            *now += scene.amount.magnitude * normal * speed;
        }
    }
}
