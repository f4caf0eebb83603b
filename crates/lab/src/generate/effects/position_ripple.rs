//! `position_ripple`: a border that is periodic in the input, as of cogging, gear teeth or a thread.

use super::card;
use super::motion::{directions, position};
use crate::generate::law::{Law, Scene};
use std::f64::consts::TAU;

pub(super) static LAWS: [&dyn Law; 4] = [&Cogging, &FrictionRipple, &TwoHarmonics, &ToothMesh];

/// `u' = u + x·sin(2πk·z + φ)` at the place `z` in the interval, 3 to 25 waves along it.
#[derive(Debug)]
struct Cogging;

impl Law for Cogging {
    card!("position_ripple", "cogging", Operator, "spans of u", 0.6);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        along(scene, v, u, |phase, _| phase.sin());
    }
}

/// The loop's width is periodic, its middle is not: the ripple changes its sign with the direction.
#[derive(Debug)]
struct FrictionRipple;

impl Law for FrictionRipple {
    card!("position_ripple", "ripple of friction", Operator, "spans of u", 0.6);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        along(scene, v, u, |phase, direction| direction * phase.sin());
    }
}

/// The second harmonic at half the height beside the first.
#[derive(Debug)]
struct TwoHarmonics;

impl Law for TwoHarmonics {
    card!("position_ripple", "two harmonics", Operator, "spans of u", 0.6);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let other = scene.amount.between(2, 0.0, TAU);
        along(scene, v, u, |phase, _| phase.sin() + 0.5 * (2.0 * phase + other).sin());
    }
}

/// A triangle along the stroke: teeth that take over from each other.
#[derive(Debug)]
struct ToothMesh;

impl Law for ToothMesh {
    card!("position_ripple", "tooth mesh", Operator, "spans of u", 0.6);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        along(scene, v, u, |phase, _| {
            let share = (phase / TAU).rem_euclid(1.0);
            4.0 * (share - 0.5).abs() - 1.0
        });
    }
}

fn along(scene: &Scene<'_>, v: &[f64], u: &mut [f64], wave: impl Fn(f64, f64) -> f64) {
    // Evenly over the logarithm: few long waves are as likely as many short ones.
    let waves = 3.0 * (25.0_f64 / 3.0).powf(scene.amount.shape[0]);
    let phase = scene.amount.between(1, 0.0, TAU);
    for (t, direction) in directions(scene.machine, v).into_iter().enumerate() {
        u[t] += scene.x() * wave(TAU * waves * position(scene.machine, v[t]) + phase, direction);
    }
}
