//! `record_offset`: the sensor's zero differs from record to record.

use super::card;
use crate::generate::law::{Law, Scene};
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};

pub(super) static LAWS: [&dyn Law; 3] = [&Normal, &Uniform, &Tare];

/// A zero set anew before each record, by nobody in particular: `y' = y + x·σ·z`, `z` standard normal, one a record.
#[derive(Debug)]
struct Normal;

impl Law for Normal {
    card!("record_offset", "normal", Sensor, "noise sd", 2000.0);

    fn sensor(&self, scene: &mut Scene<'_>, y: &mut [f64]) {
        let z: f64 = StandardNormal.sample(&mut scene.rng);
        shift(y, scene.x() * scene.machine.noise_sd * z);
    }
}

/// A zero set anew by a screw that is turned until the reading is within a tolerance: `y' = y + x·σ·z`, `z` uniform with variance 1.
#[derive(Debug)]
struct Uniform;

impl Law for Uniform {
    card!("record_offset", "uniform", Sensor, "noise sd", 2000.0);

    fn sensor(&self, scene: &mut Scene<'_>, y: &mut [f64]) {
        let half = 3.0_f64.sqrt();
        let z = scene.rng.random_range(-half..half);
        shift(y, scene.x() * scene.machine.noise_sd * z);
    }
}

/// A tare: what the sensor reads when a record begins becomes its zero, or a share of it, as where the tare button works through
/// a filter that has not settled: `y' = y − x·y(first)`.
#[derive(Debug)]
struct Tare;

impl Law for Tare {
    card!("record_offset", "tare", Sensor, "share of the first reading", 1.0);

    fn sensor(&self, scene: &mut Scene<'_>, y: &mut [f64]) {
        shift(y, -scene.x() * y[scene.passage.lead]);
    }
}

fn shift(y: &mut [f64], by: f64) {
    y.iter_mut().for_each(|y| *y += by);
}
