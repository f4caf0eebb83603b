//! `resonance`: a lightly damped mode beside the nominal dynamics.

use super::card;
use crate::generate::law::{Amount, Law, Scene};
use std::f64::consts::PI;

pub(super) static LAWS: [&dyn Law; 3] = [&ParallelMode, &TwoModes, &Notch];

/// `u' = u + x·M(q⁻¹)u`, `M` a band-pass of unit peak at a random frequency, pole radius 0.93 to 0.99.
#[derive(Debug)]
struct ParallelMode;

impl Law for ParallelMode {
    card!("resonance", "parallel mode", Dynamics, "peak gain of the mode over that of u", 5.0);

    fn dynamics(&self, scene: &mut Scene<'_>, u: &mut [f64]) {
        let mode = band_pass(frequency(&scene.amount, 0), scene.amount.between(1, 0.93, 0.99), u);
        u.iter_mut().zip(mode).for_each(|(u, m)| *u += scene.amount.magnitude * m);
    }
}

/// Two modes of half the size each.
#[derive(Debug)]
struct TwoModes;

impl Law for TwoModes {
    card!("resonance", "two modes", Dynamics, "peak gain of the modes over that of u", 5.0);

    fn dynamics(&self, scene: &mut Scene<'_>, u: &mut [f64]) {
        let radius = scene.amount.between(1, 0.95, 0.99);
        let first = band_pass(frequency(&scene.amount, 0), radius, u);
        let second = band_pass(frequency(&scene.amount, 2), radius, u);
        for ((u, first), second) in u.iter_mut().zip(first).zip(second) {
            *u += scene.amount.magnitude * 0.5 * (first + second);
        }
    }
}

/// An antiresonance: the band-pass is taken away, all of it at x = 1.
#[derive(Debug)]
struct Notch;

impl Law for Notch {
    card!("resonance", "antiresonance", Dynamics, "depth", 1.0);

    fn dynamics(&self, scene: &mut Scene<'_>, u: &mut [f64]) {
        let mode = band_pass(frequency(&scene.amount, 0), scene.amount.between(1, 0.85, 0.97), u);
        u.iter_mut().zip(mode).for_each(|(u, m)| *u -= scene.amount.magnitude * m);
    }
}

fn frequency(amount: &Amount, i: usize) -> f64 {
    PI * amount.between(i, 0.08, 0.75)
}

/// `(1−r²)/2 · (1 − q⁻²)/(1 − 2r·cos ω q⁻¹ + r² q⁻²)`: gain one at ω (close to it for r near 1), none at rest.
fn band_pass(frequency: f64, radius: f64, u: &[f64]) -> Vec<f64> {
    let (a1, a2) = (-2.0 * radius * frequency.cos(), radius * radius);
    let gain = 0.5 * (1.0 - radius * radius);
    let mut y = vec![0.0; u.len()];
    for t in 0..u.len() {
        let past = |i: usize| u[t.saturating_sub(i)];
        let (y1, y2) = (if t > 0 { y[t - 1] } else { 0.0 }, if t > 1 { y[t - 2] } else { 0.0 });
        y[t] = gain * (past(0) - past(2)) - a1 * y1 - a2 * y2;
    }
    y
}
