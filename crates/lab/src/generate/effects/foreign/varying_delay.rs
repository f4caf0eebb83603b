//! `varying_delay`: a delay that comes and goes slowly.

use crate::generate::effects::card;
use crate::generate::law::{Law, Scene};
use std::f64::consts::TAU;

pub(super) static LAWS: [&dyn Law; 1] = [&SlowWave];

/// `u'(t) = u(t − x(1 + sin)/2)`, one to six waves over the dataset, straight between samples.
#[derive(Debug)]
struct SlowWave;

impl Law for SlowWave {
    card!("varying_delay", "slow wave", Input, "samples", 8.0);

    fn dynamics(&self, scene: &mut Scene<'_>, u: &mut [f64]) {
        let (waves, phase) = (scene.amount.between(0, 1.0, 6.0), scene.amount.between(1, 0.0, TAU));
        let before = u.to_vec();
        for t in 0..u.len() {
            let wave = (TAU * waves * scene.passage.clock(t) + phase).sin();
            let delay = 0.5 * scene.x() * (1.0 + wave);
            let (whole, part) = (delay.floor(), delay.fract());
            let near = before[t.saturating_sub(whole as usize)];
            u[t] = near + part * (before[t.saturating_sub(whole as usize + 1)] - near);
        }
    }
}
