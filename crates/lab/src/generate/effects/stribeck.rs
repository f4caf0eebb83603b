//! `stribeck`: friction is higher while the motion is slow.

use super::card;
use super::motion::{directions, last_moves, moves};
use crate::generate::law::{Law, Scene};

pub(super) static LAWS: [&dyn Law; 3] = [&Gaussian, &Hyperbolic, &Bristle];

/// `u' = u + x·s·e^{−(Δv/v_s)²}`, kept at rest; `v_s` 0.01 to 0.06 widths a sample.
///
/// B. Armstrong-Hélouvry, P. Dupont, C. Canudas de Wit, Automatica 30(7), 1994, with exponent 2.
#[derive(Debug)]
struct Gaussian;

impl Law for Gaussian {
    card!("stribeck", "Gaussian", Operator, "spans of u", 1.0);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        at_low_speed(scene, v, u, |ratio| (-ratio * ratio).exp());
    }
}

/// `u' = u + x·s/(1 + |Δv|/v_s)`, the law of Hess and Soom.
#[derive(Debug)]
struct Hyperbolic;

impl Law for Hyperbolic {
    card!("stribeck", "hyperbolic", Operator, "spans of u", 1.0);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        at_low_speed(scene, v, u, |ratio| 1.0 / (1.0 + ratio));
    }
}

/// A bristle that bends towards the Stribeck force along a travel of 0.02 widths, as in the LuGre model.
///
/// C. Canudas de Wit, H. Olsson, K. J. Åström, P. Lischinsky, IEEE Trans. Autom. Control 40(3), 1995.
#[derive(Debug)]
struct Bristle;

impl Law for Bristle {
    card!("stribeck", "LuGre bristle", Operator, "spans of u", 1.0);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let slow = scene.amount.between(0, 0.01, 0.06);
        let directions = directions(scene.machine, v);
        let mut bristle = 0.0;
        for (t, speed) in moves(scene.machine, v).into_iter().enumerate() {
            let aim = directions[t] * (-(speed / slow).powi(2)).exp();
            bristle += (aim - bristle) * (1.0 - (-speed.abs() / 0.02).exp());
            u[t] += scene.x() * bristle;
        }
    }
}

fn at_low_speed(scene: &Scene<'_>, v: &[f64], u: &mut [f64], force: impl Fn(f64) -> f64) {
    let slow = scene.amount.between(0, 0.01, 0.06);
    for (t, speed) in last_moves(scene.machine, v).into_iter().enumerate() {
        let side = if speed == 0.0 { 0.0 } else { speed.signum() };
        u[t] += scene.x() * side * force(speed.abs() / slow);
    }
}
