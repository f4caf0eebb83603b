//! `gain_noise`: a gain that flickers.

use crate::generate::effects::card;
use crate::generate::law::{Law, Scene};
use rand_distr::{Distribution, StandardNormal};

pub(super) static LAWS: [&dyn Law; 1] = [&FlickeringGain];

/// `u' = ū + (u − ū)(1 + x·w)`, `w` first-order noise of unit variance with a pole of 0.2 to 0.97.
#[derive(Debug)]
struct FlickeringGain;

impl Law for FlickeringGain {
    card!("gain_noise", "flickering gain", Dynamics, "share of the gain", 0.6);

    fn dynamics(&self, scene: &mut Scene<'_>, u: &mut [f64]) {
        let centre = 0.5 * (scene.machine.hysteresis.u_low() + scene.machine.hysteresis.u_high());
        let pole = scene.amount.between(0, 0.2, 0.97);
        let mut flicker = 0.0;
        for now in u {
            let normal: f64 = StandardNormal.sample(&mut scene.rng);
            flicker = pole * flicker + (1.0 - pole * pole).sqrt() * normal;
            *now += scene.amount.magnitude * flicker * (*now - centre);
        }
    }
}
