//! `alternating_loops`: a subharmonic; every second stroke runs off the border.

use crate::generate::effects::card;
use crate::generate::effects::motion::directions;
use crate::generate::law::{Law, Scene};

pub(super) static LAWS: [&dyn Law; 1] = [&EverySecondStroke];

/// `u' = u + x` on the strokes 3, 4, 7, 8, … of each passage: period two in whole cycles.
#[derive(Debug)]
struct EverySecondStroke;

impl Law for EverySecondStroke {
    card!("alternating_loops", "every second cycle", Operator, "spans of u", 0.5);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let directions = directions(scene.machine, v);
        let mut strokes = 0_usize;
        for t in 1..v.len() {
            strokes += usize::from(directions[t] != directions[t - 1]);
            if (strokes / 2) % 2 == 1 {
                u[t] += scene.x();
            }
        }
    }
}
