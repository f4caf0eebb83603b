//! `loop_size_memory`: the border depends on where the last reversal was.

use crate::generate::effects::card;
use crate::generate::effects::motion::{directions, position};
use crate::generate::law::{Law, Scene};

pub(super) static LAWS: [&dyn Law; 1] = [&ReversalMemory];

/// `u' = u + x·(z_r − 1/2)·(1 − z)·z·4`, `z_r` the place of the last reversal and `z` the present one.
#[derive(Debug)]
struct ReversalMemory;

impl Law for ReversalMemory {
    card!("loop_size_memory", "reversal memory", Operator, "spans of u", 1.0);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let directions = directions(scene.machine, v);
        let mut reversal = position(scene.machine, v[0]);
        for t in 1..v.len() {
            if directions[t] != directions[t - 1] {
                reversal = position(scene.machine, v[t - 1]);
            }
            let z = position(scene.machine, v[t]);
            u[t] += scene.x() * (reversal - 0.5) * 4.0 * z * (1.0 - z);
        }
    }
}
