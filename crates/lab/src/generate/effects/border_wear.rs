//! `border_wear`: the borders change with accumulated travel.

use super::card;
use super::motion::{directions, half_width, position};
use crate::generate::law::{Law, Scene};

pub(super) static LAWS: [&dyn Law; 4] = [&Linear, &RunIn, &OneBorder, &Pitting];

/// The loop narrows in proportion to travel: half-width × `(1 − x·w)`, `w` from 0 to 1 over the dataset.
#[derive(Debug)]
struct Linear;

impl Law for Linear {
    card!("border_wear", "linear", Operator, "half-widths of the loop", 1.0);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        wear(scene, v, u, |worn, _| worn);
    }
}

/// A run-in that ends: `w' = 1 − e^{−kw}`, k 3 to 8.
#[derive(Debug)]
struct RunIn;

impl Law for RunIn {
    card!("border_wear", "run-in", Operator, "half-widths of the loop", 1.0);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let rate = scene.amount.between(0, 3.0, 8.0);
        wear(scene, v, u, |worn, _| 1.0 - (-rate * worn).exp());
    }
}

/// Only one of the borders moves, and as a whole: `C' = C ∓ x·w`.
#[derive(Debug)]
struct OneBorder;

impl Law for OneBorder {
    card!("border_wear", "one border", Operator, "spans of u", 0.5);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let side = scene.amount.sign(0);
        let directions = directions(scene.machine, v);
        for (t, worn) in scene.passage.wear_clock().into_iter().enumerate() {
            if directions[t] == side {
                u[t] -= scene.x() * worn * side;
            }
        }
    }
}

/// Wear about one place of the stroke: half-width × `(1 − x·w·e^{−((v−c)/0.15)²})`.
#[derive(Debug)]
struct Pitting;

impl Law for Pitting {
    card!("border_wear", "pitting", Operator, "half-widths of the loop", 1.0);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let centre = scene.amount.between(0, 0.25, 0.75);
        let machine = scene.machine;
        wear(scene, v, u, |worn, v| worn * (-((position(machine, v) - centre) / 0.15).powi(2)).exp());
    }
}

fn wear(scene: &Scene<'_>, v: &[f64], u: &mut [f64], depth: impl Fn(f64, f64) -> f64) {
    let directions = directions(scene.machine, v);
    for (t, worn) in scene.passage.wear_clock().into_iter().enumerate() {
        u[t] -= scene.x() * depth(worn, v[t]) * directions[t] * half_width(scene.machine, v[t]);
    }
}
