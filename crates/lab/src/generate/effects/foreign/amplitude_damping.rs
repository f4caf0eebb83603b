//! `amplitude_damping`: the linear part is none; its feedback grows with the output.

use crate::generate::effects::card;
use crate::generate::law::{Law, Scene};

pub(super) static LAWS: [&dyn Law; 1] = [&CubicDamping];

/// `y(t) = … − x·e³/P²` with `e = y(t−1) − ȳ` and `P` the most the output can reach: a Duffing-like term.
#[derive(Debug)]
struct CubicDamping;

impl Law for CubicDamping {
    card!("amplitude_damping", "cubic feedback", Dynamics, "gain of the cubic", 0.2);

    fn feedback(&self, scene: &Scene<'_>, y_before: f64) -> f64 {
        let range = scene.machine.reach;
        let e = ((y_before - scene.machine.y_centre()) / range).clamp(-1.5, 1.5);
        -scene.x() * range * e * e * e
    }
}
