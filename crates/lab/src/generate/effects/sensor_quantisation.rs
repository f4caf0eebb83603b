//! `sensor_quantisation`: the reading lies on a lattice.

use super::card;
use crate::generate::law::{Law, Nature, Scene};

pub(super) static LAWS: [&dyn Law; 3] = [&Rounding, &Truncation, &UnevenCodes];

/// Rounding to multiples of `x·σ`.
#[derive(Debug)]
struct Rounding;

impl Law for Rounding {
    card!("sensor_quantisation", "rounding", Sensor, "noise sd", 3000.0);

    fn nature(&self) -> Nature {
        Nature::Noise
    }

    fn sensor(&self, scene: &mut Scene<'_>, y: &mut [f64]) {
        on_lattice(scene, y, f64::round);
    }
}

/// Truncation towards minus infinity, with a lattice that does not start at zero.
#[derive(Debug)]
struct Truncation;

impl Law for Truncation {
    card!("sensor_quantisation", "truncation", Sensor, "noise sd", 3000.0);

    fn nature(&self) -> Nature {
        Nature::Noise
    }

    fn sensor(&self, scene: &mut Scene<'_>, y: &mut [f64]) {
        let offset = scene.amount.shape[0];
        on_lattice(scene, y, |code| (code - offset).floor() + offset);
    }
}

/// Codes of uneven width, every other one a third wider: a converter with differential nonlinearity.
#[derive(Debug)]
struct UnevenCodes;

impl Law for UnevenCodes {
    card!("sensor_quantisation", "uneven codes", Sensor, "noise sd", 3000.0);

    fn nature(&self) -> Nature {
        Nature::Noise
    }

    fn sensor(&self, scene: &mut Scene<'_>, y: &mut [f64]) {
        on_lattice(scene, y, |code| {
            let pair = 2.0 * (0.5 * code).floor();
            if code - pair < 4.0 / 3.0 { pair + 2.0 / 3.0 } else { pair + 5.0 / 3.0 }
        });
    }
}

fn on_lattice(scene: &Scene<'_>, y: &mut [f64], code: impl Fn(f64) -> f64) {
    let step = scene.x() * scene.machine.noise_sd;
    if step == 0.0 {
        return;
    }
    y.iter_mut().for_each(|y| *y = step * code(*y / step));
}
