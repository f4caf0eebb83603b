//! `thermal_step`: for a while, one border lies elsewhere.

use crate::generate::effects::card;
use crate::generate::effects::motion::directions;
use crate::generate::law::{Law, Scene};

pub(super) static LAWS: [&dyn Law; 1] = [&OneBorderForAWhile];

/// `u' = u + x` on one border only, during a fifth to two fifths of the dataset, and then as before.
#[derive(Debug)]
struct OneBorderForAWhile;

impl Law for OneBorderForAWhile {
    card!("thermal_step", "one border for a while", Operator, "spans of u", 0.5);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let side = scene.amount.sign(0);
        let start = scene.amount.between(1, 0.1, 0.5);
        let end = start + scene.amount.between(2, 0.2, 0.4);
        for (t, direction) in directions(scene.machine, v).into_iter().enumerate() {
            if direction == side && (start..end).contains(&scene.passage.clock(t)) {
                u[t] += scene.x();
            }
        }
    }
}
