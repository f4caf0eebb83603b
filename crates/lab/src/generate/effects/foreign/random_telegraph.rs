//! `random_telegraph`: a disturbance that jumps between two levels at random instants.

use crate::generate::effects::card;
use crate::generate::law::{Law, Scene};
use rand::RngExt;

pub(super) static LAWS: [&dyn Law; 1] = [&TwoLevels];

/// `u' = u ± x/2`, the sign changing after 10 to 200 samples.
#[derive(Debug)]
struct TwoLevels;

impl Law for TwoLevels {
    card!("random_telegraph", "two levels", Disturbance, "spans of u", 1.0);

    fn dynamics(&self, scene: &mut Scene<'_>, u: &mut [f64]) {
        let (mut side, mut left) = (0.5, 0);
        for now in u {
            if left == 0 {
                side = -side;
                left = scene.rng.random_range(10..200);
            }
            left -= 1;
            *now += scene.amount.magnitude * side;
        }
    }
}
