//! `maximum_memory`: the largest stroke so far leaves its mark (the Mullins effect of filled rubber).

use crate::generate::effects::card;
use crate::generate::effects::motion::position;
use crate::generate::law::{Law, Scene};

pub(super) static LAWS: [&dyn Law; 1] = [&Softening];

/// `u' = u·(1 − x·(m − |2z − 1|))` with `m` the largest `|2z − 1|` so far in the record: softer below the largest stroke.
#[derive(Debug)]
struct Softening;

impl Law for Softening {
    card!("maximum_memory", "softening below the largest stroke", Operator, "share of u", 0.9);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let mut largest = 0.0_f64;
        for t in scene.passage.lead.min(v.len())..v.len() {
            let stroke = (2.0 * position(scene.machine, v[t]) - 1.0).abs();
            largest = largest.max(stroke);
            u[t] -= scene.x() * (largest - stroke) * u[t];
        }
    }
}
