//! `heating`: motion warms the machine, warmth tilts its borders.

use crate::generate::effects::card;
use crate::generate::effects::motion::{moves, position};
use crate::generate::law::{Law, Scene};

pub(super) static LAWS: [&dyn Law; 1] = [&WarmByMotion];

/// `u' = u + x·ℓ·(z − z₀)`, `ℓ` the speed's mean over the last 50 to 400 samples in fiftieths of a width, `z` the place in the interval.
#[derive(Debug)]
struct WarmByMotion;

impl Law for WarmByMotion {
    card!("heating", "warm by motion", Operator, "spans of u", 3.0);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let (time, place) = (scene.amount.between(0, 50.0, 400.0), scene.amount.shape[1]);
        let mut warmth = 0.0;
        for (t, step) in moves(scene.machine, v).into_iter().enumerate() {
            warmth += (50.0 * step.abs() - warmth) / time;
            u[t] += scene.x() * warmth * (position(scene.machine, v[t]) - place);
        }
    }
}
