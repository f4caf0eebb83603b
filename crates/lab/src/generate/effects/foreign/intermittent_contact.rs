//! `intermittent_contact`: at random times the drive loses part of its grip.

use crate::generate::effects::card;
use crate::generate::law::{Law, Scene};
use rand::RngExt;

pub(super) static LAWS: [&dyn Law; 1] = [&LostGrip];

/// In episodes of 5 to 60 samples, one in 300 samples, `u' = u − x·(u − ū)`.
#[derive(Debug)]
struct LostGrip;

impl Law for LostGrip {
    card!("intermittent_contact", "lost grip", Dynamics, "share of u", 1.0);

    fn dynamics(&self, scene: &mut Scene<'_>, u: &mut [f64]) {
        let centre = 0.5 * (scene.machine.hysteresis.u_low() + scene.machine.hysteresis.u_high());
        let mut left = 0;
        for now in u {
            if left == 0 && scene.rng.random_bool(1.0 / 300.0) {
                left = scene.rng.random_range(5..60);
            }
            if left > 0 {
                left -= 1;
                *now -= scene.amount.magnitude * (*now - centre);
            }
        }
    }
}
