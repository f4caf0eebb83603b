//! `sensor_saturation`: the sensor does not follow to the end of the range.

use super::card;
use crate::generate::law::{Law, Scene};

pub(super) static LAWS: [&dyn Law; 3] = [&Clipping, &OneSided, &SoftKnee];

/// Hard clipping at both ends: `|y − ȳ| ≤ (1−x)·P`, `P` the most the noise-free output can reach.
#[derive(Debug)]
struct Clipping;

impl Law for Clipping {
    card!("sensor_saturation", "clipping", Sensor, "share of the range lost", 0.95);

    fn sensor(&self, scene: &mut Scene<'_>, y: &mut [f64]) {
        beyond(scene, y, |excess, _| -excess);
    }
}

/// Clipping at one end.
#[derive(Debug)]
struct OneSided;

impl Law for OneSided {
    card!("sensor_saturation", "one-sided clipping", Sensor, "share of the range lost", 0.95);

    fn sensor(&self, scene: &mut Scene<'_>, y: &mut [f64]) {
        let side = scene.amount.sign(0);
        beyond(scene, y, |excess, _| if excess * side > 0.0 { -excess } else { 0.0 });
    }
}

/// A knee beyond which the reading creeps up to a ceiling: `e' = h·e/(h + |e|)`, `h` a tenth of the range.
#[derive(Debug)]
struct SoftKnee;

impl Law for SoftKnee {
    card!("sensor_saturation", "soft knee", Sensor, "share of the range lost", 0.95);

    fn sensor(&self, scene: &mut Scene<'_>, y: &mut [f64]) {
        beyond(scene, y, |excess, range| {
            let headroom = 0.1 * range;
            headroom * excess / (headroom + excess.abs()) - excess
        });
    }
}

/// Adds `change(e, P)` wherever the output exceeds the limit by `e ≠ 0`.
fn beyond(scene: &Scene<'_>, y: &mut [f64], change: impl Fn(f64, f64) -> f64) {
    if scene.x() == 0.0 {
        return; // noise may exceed even the full range
    }
    let centre = scene.machine.y_centre();
    let range = scene.machine.reach;
    let limit = range * (1.0 - scene.x());
    for now in y {
        let excess = (*now - centre).abs() - limit;
        if excess > 0.0 {
            *now += change(excess.copysign(*now - centre), range);
        }
    }
}
