//! `border_resolution`: the borders have structure between the levels of the pulse experiments.

use super::card;
use super::motion::{directions, position};
use crate::generate::law::{Law, Scene};
use std::f64::consts::PI;

pub(super) static LAWS: [&dyn Law; 3] = [&Jump, &Bump, &Ripple];

/// One cell of each border climbs by a jump of `x` instead of a ramp.
#[derive(Debug)]
struct Jump;

impl Law for Jump {
    card!("border_resolution", "jump", Operator, "spans of u", 1.0);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let place = scene.amount.between(2, 0.2, 0.8);
        in_one_cell(scene, v, u, |share| if share < place { -share } else { 1.0 - share });
    }
}

/// One cell of each border bulges by a triangle of height `x`.
#[derive(Debug)]
struct Bump;

impl Law for Bump {
    card!("border_resolution", "bump", Operator, "spans of u", 1.0);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        in_one_cell(scene, v, u, |share| 2.0 * share.min(1.0 - share));
    }
}

/// A ripple of one wave every two cells, zero at all levels.
#[derive(Debug)]
struct Ripple;

impl Law for Ripple {
    card!("border_resolution", "ripple", Operator, "spans of u", 0.5);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let cells = (scene.machine.levels.len() - 1) as f64;
        for (u, &v) in u.iter_mut().zip(v) {
            *u += scene.x() * (PI * cells * position(scene.machine, v)).sin();
        }
    }
}

/// Adds `x·shape(share of the cell)` in one inner cell of each border, zero at its ends.
fn in_one_cell(scene: &Scene<'_>, v: &[f64], u: &mut [f64], shape: impl Fn(f64) -> f64) {
    let cells = scene.machine.levels.len() - 1;
    let cell = |i: usize| 1.0 + (scene.amount.shape[i] * (cells - 2) as f64).floor();
    let (rising, falling) = (cell(0), cell(1));
    for (t, direction) in directions(scene.machine, v).into_iter().enumerate() {
        let place = cells as f64 * position(scene.machine, v[t]);
        let share = place - if direction > 0.0 { rising } else { falling };
        if (0.0..1.0).contains(&share) {
            u[t] += scene.x() * shape(share);
        }
    }
}
