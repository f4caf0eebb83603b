//! `dwell_sticking`: the longer the rest, the more travel it takes to break loose.

use crate::generate::effects::card;
use crate::generate::effects::motion::moves;
use crate::generate::law::{Law, Scene};

pub(super) static LAWS: [&dyn Law; 1] = [&BreakAway];

/// After a rest of τ samples, `u` is pulled back by `x·ln(1+τ)·e^{−travel/0.05}` against the new direction.
#[derive(Debug)]
struct BreakAway;

impl Law for BreakAway {
    card!("dwell_sticking", "break-away", Operator, "spans of u a logarithm of rest", 2.0);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let (mut rest, mut travel, mut grip) = (0.0_f64, 0.0, 0.0);
        for (t, step) in moves(scene.machine, v).into_iter().enumerate() {
            if step == 0.0 {
                rest += 1.0;
                continue;
            }
            if rest > 0.0 {
                // Long rests saturate: the lead-in is no longer than that to a contact.
                (grip, travel, rest) = ((1.0 + rest.min(50.0)).ln(), 0.0, 0.0);
            }
            u[t] -= scene.x() * grip * step.signum() * (-travel / 0.05_f64).exp();
            travel += step.abs();
        }
    }
}
