//! `coloured_noise`: the equation error remembers. Its innovations keep the rig's noise level.

use super::card;
use crate::generate::law::{Law, Nature, Scene};

pub(super) static LAWS: [&dyn Law; 3] = [&FirstOrder, &MovingAverage, &Resonant];

/// AR(1): `ξ'(t) = x·ξ'(t−1) + ξ(t)`.
#[derive(Debug)]
struct FirstOrder;

impl Law for FirstOrder {
    card!("coloured_noise", "AR(1)", Disturbance, "pole", 0.995);

    fn nature(&self) -> Nature {
        Nature::Noise
    }

    fn equation_error(&self, scene: &mut Scene<'_>, _u: &[f64], xi: &mut [f64]) {
        for t in 1..xi.len() {
            xi[t] += scene.x() * xi[t - 1];
        }
    }
}

/// MA(6) with equal weights: `ξ' = (1 + x(q⁻¹ + … + q⁻⁶))ξ`, invertible for x < 1.
#[derive(Debug)]
struct MovingAverage;

impl Law for MovingAverage {
    card!("coloured_noise", "MA(6)", Disturbance, "weight", 0.99);

    fn nature(&self) -> Nature {
        Nature::Noise
    }

    fn equation_error(&self, scene: &mut Scene<'_>, _u: &[f64], xi: &mut [f64]) {
        for t in (0..xi.len()).rev() {
            let past: f64 = xi[t.saturating_sub(6)..t].iter().sum();
            xi[t] += scene.x() * past;
        }
    }
}

/// AR(2) with a pole pair of radius x: vibration of the surroundings.
#[derive(Debug)]
struct Resonant;

impl Law for Resonant {
    card!("coloured_noise", "resonant AR(2)", Disturbance, "pole radius", 0.995);

    fn nature(&self) -> Nature {
        Nature::Noise
    }

    fn equation_error(&self, scene: &mut Scene<'_>, _u: &[f64], xi: &mut [f64]) {
        let radius = scene.x();
        let angle = std::f64::consts::PI * scene.amount.between(0, 0.1, 0.7);
        for t in 2..xi.len() {
            xi[t] += 2.0 * radius * angle.cos() * xi[t - 1] - radius * radius * xi[t - 2];
        }
    }
}
