//! `input_delay`: the actuator answers late.

use super::card;
use crate::law::{Law, Scene};

pub(super) static LAWS: [&dyn Law; 2] = [&HeldCommand, &LateClock];

/// A held command that arrives `d = k + f` samples late: `u'(t) = (1−f)·u(t−k) + f·u(t−k−1)`.
#[derive(Debug)]
struct HeldCommand;

impl Law for HeldCommand {
    card!("input_delay", "held command", Input, "samples", 4.0);

    fn dynamics(&self, scene: &mut Scene<'_>, u: &mut [f64]) {
        let (whole, part) = split(scene.x());
        shift(u, whole);
        for t in (1..u.len()).rev() {
            u[t] += part * (u[t - 1] - u[t]);
        }
    }
}

/// The fractional part by quadratic interpolation (Lagrange): a smooth command that a late clock samples.
///
/// `u'(t) = ½(f−1)(f−2)·u(t) − f(f−2)·u(t−1) + ½f(f−1)·u(t−2)`
#[derive(Debug)]
struct LateClock;

impl Law for LateClock {
    card!("input_delay", "late clock", Input, "samples", 4.0);

    fn dynamics(&self, scene: &mut Scene<'_>, u: &mut [f64]) {
        let (whole, f) = split(scene.x());
        shift(u, whole);
        for t in (2..u.len()).rev() {
            // As differences from u(t): no fraction, no change, to the bit.
            u[t] += f * (2.0 - f) * (u[t - 1] - u[t]) + 0.5 * f * (f - 1.0) * (u[t - 2] - u[t]);
        }
    }
}

fn split(delay: f64) -> (usize, f64) {
    (delay.floor() as usize, delay.fract())
}

fn shift(u: &mut [f64], whole: usize) {
    for t in (1..u.len()).rev() {
        u[t] = u[t.saturating_sub(whole)];
    }
}
