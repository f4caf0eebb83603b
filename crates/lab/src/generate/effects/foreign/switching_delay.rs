//! `switching_delay`: a bus that delivers some commands a sample late.

use crate::generate::effects::card;
use crate::generate::law::{Law, Scene};
use rand::RngExt;

pub(super) static LAWS: [&dyn Law; 1] = [&LateEpisodes];

/// In episodes of 20 to 200 samples, about a third of the time, `u'(t) = (1−x)·u(t) + x·u(t−1)`.
#[derive(Debug)]
struct LateEpisodes;

impl Law for LateEpisodes {
    card!("switching_delay", "late episodes", Input, "samples", 1.0);

    fn dynamics(&self, scene: &mut Scene<'_>, u: &mut [f64]) {
        let mut before = u[0];
        let (mut late, mut left) = (false, 0);
        for now in u {
            if left == 0 {
                late = scene.rng.random_bool(1.0 / 3.0);
                left = scene.rng.random_range(20..200);
            }
            left -= 1;
            let instant = *now;
            if late {
                *now += scene.amount.magnitude * (before - instant);
            }
            before = instant;
        }
    }
}
