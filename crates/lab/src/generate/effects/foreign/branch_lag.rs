//! `branch_lag`: what follows at once in one direction lags in the other.

use crate::generate::effects::card;
use crate::generate::effects::motion::directions;
use crate::generate::law::{Law, Scene};

pub(super) static LAWS: [&dyn Law; 1] = [&OneDirection];

/// `u'(t) = x·u'(t−1) + (1−x)·u(t)` on one border, `u' = u` on the other.
#[derive(Debug)]
struct OneDirection;

impl Law for OneDirection {
    card!("branch_lag", "one direction lags", Operator, "pole", 0.97);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let side = scene.amount.sign(0);
        let mut state = u[0];
        for (t, direction) in directions(scene.machine, v).into_iter().enumerate() {
            if direction == side {
                u[t] += scene.x() * (state - u[t]);
            }
            state = u[t];
        }
    }
}
