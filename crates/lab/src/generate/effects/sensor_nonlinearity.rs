//! `sensor_nonlinearity`: the sensor's characteristic is not straight.

use super::card;
use crate::generate::law::{Law, Scene};

pub(super) static LAWS: [&dyn Law; 3] = [&Quadratic, &Cubic, &SoftCentre];

/// `e' = e + x·e²/P`, `e` the output from its centre and `P` the most it can reach; monotone for x < 1/2.
#[derive(Debug)]
struct Quadratic;

impl Law for Quadratic {
    card!("sensor_nonlinearity", "quadratic", Sensor, "share of the range", 0.45);

    fn sensor(&self, scene: &mut Scene<'_>, y: &mut [f64]) {
        let side = scene.amount.sign(0);
        bend(scene, y, |e| side * e * e);
    }
}

/// `e' = e − x·e³/P²`; monotone for x < 1/3.
#[derive(Debug)]
struct Cubic;

impl Law for Cubic {
    card!("sensor_nonlinearity", "cubic", Sensor, "share of the range", 0.3);

    fn sensor(&self, scene: &mut Scene<'_>, y: &mut [f64]) {
        bend(scene, y, |e| -e * e * e);
    }
}

/// Less sensitive about the centre, as of a differential transformer near its null: `e' = e − x·w·tanh(e/w)`, `w = P/8`.
#[derive(Debug)]
struct SoftCentre;

impl Law for SoftCentre {
    card!("sensor_nonlinearity", "soft centre", Sensor, "sensitivity lost at the centre", 0.9);

    fn sensor(&self, scene: &mut Scene<'_>, y: &mut [f64]) {
        bend(scene, y, |e| -0.125 * (8.0 * e).tanh());
    }
}

/// Adds `x·P·shape(e/P)`.
fn bend(scene: &Scene<'_>, y: &mut [f64], shape: impl Fn(f64) -> f64) {
    let centre = scene.machine.y_centre();
    let range = scene.machine.reach;
    for now in y {
        *now += scene.x() * range * shape((*now - centre) / range);
    }
}
