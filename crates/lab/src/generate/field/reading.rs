//! A recorded input that was measured, not commanded.

use crate::generate::effects::card;
use crate::generate::law::{INTERVAL_WIDTHS, Injection, Law, Nature, Scene};
use rand_distr::{Distribution, StandardNormal};

/// White Gaussian noise of standard deviation `x` on the record of the input, at rest too; the machine never feels it.
#[derive(Debug)]
pub(crate) struct Reading;

impl Law for Reading {
    card!("input_noise", "noise of the input's sensor", Input, INTERVAL_WIDTHS, 0.2);

    fn nature(&self) -> Nature {
        Nature::Noise
    }

    fn injection(&self) -> Injection {
        Injection::Recording
    }

    fn recording(&self, scene: &mut Scene<'_>, v: &mut [f64]) {
        let sd = scene.x() * scene.machine.interval.width();
        for now in v {
            let normal: f64 = StandardNormal.sample(&mut scene.rng);
            *now += sd * normal;
        }
    }
}
