//! `proportional_noise`: noise that grows with the deflection.

use crate::generate::effects::card;
use crate::generate::law::{Law, Nature, Scene};
use rand_distr::{Distribution, StandardNormal};

pub(super) static LAWS: [&dyn Law; 1] = [&GrowsWithDeflection];

/// `ξ' = ξ + x·σ·(u − u_m)²·w`, `w` white of unit variance: quiet at one end of the range, loud at the other.
#[derive(Debug)]
struct GrowsWithDeflection;

impl Law for GrowsWithDeflection {
    card!("proportional_noise", "grows with deflection", Disturbance, "noise sd", 100.0);

    fn nature(&self) -> Nature {
        Nature::Noise
    }

    fn equation_error(&self, scene: &mut Scene<'_>, u: &[f64], xi: &mut [f64]) {
        let scale = scene.x() * scene.machine.noise_sd;
        let low = scene.machine.hysteresis.u_low();
        for (now, u) in xi.iter_mut().zip(u) {
            let normal: f64 = StandardNormal.sample(&mut scene.rng);
            *now += scale * (u - low).powi(2) * normal;
        }
    }
}
