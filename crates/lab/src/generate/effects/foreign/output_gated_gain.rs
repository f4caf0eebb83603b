//! `output_gated_gain`: the input's gain depends on the slow state of the output (a bilinear system).

use crate::generate::effects::card;
use crate::generate::law::{Law, Scene};

pub(super) static LAWS: [&dyn Law; 1] = [&Bilinear];

/// `u' = u·(1 + x·ℓ)`, `ℓ` the mean of `u − ū` over the last 30 samples or so.
#[derive(Debug)]
struct Bilinear;

impl Law for Bilinear {
    card!("output_gated_gain", "bilinear", Dynamics, "gain a span of u", 3.0);

    fn dynamics(&self, scene: &mut Scene<'_>, u: &mut [f64]) {
        let centre = 0.5 * (scene.machine.hysteresis.u_low() + scene.machine.hysteresis.u_high());
        let mut slow = u[0] - centre;
        for now in u {
            let instant = *now;
            *now += scene.amount.magnitude * slow * (instant - centre);
            slow += (instant - centre - slow) / 30.0;
        }
    }
}
