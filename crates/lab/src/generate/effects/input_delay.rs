//! `input_delay`: the actuator answers late.

use super::card;
use crate::generate::law::{Injection, Law, Scene};

pub(super) static LAWS: [&dyn Law; 2] = [&HeldCommand, &LateClock];

/// Laws that examinations do not draw.
pub(super) static FURTHER_LAWS: [&dyn Law; 1] = [&ByPosition];

/// A held command that arrives `d = k + f` samples late: `u'(t) = (1−f)·u(t−k) + f·u(t−k−1)`.
#[derive(Debug)]
struct HeldCommand;

impl Law for HeldCommand {
    card!("input_delay", "held command", Input, "samples", 4.0);

    fn injection(&self) -> Injection {
        Injection::Recording
    }

    fn recording(&self, scene: &mut Scene<'_>, v: &mut [f64]) {
        recorded_early(scene.x(), v);
    }

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

    fn injection(&self) -> Injection {
        Injection::Recording
    }

    fn recording(&self, scene: &mut Scene<'_>, v: &mut [f64]) {
        recorded_early(scene.x(), v);
    }

    fn dynamics(&self, scene: &mut Scene<'_>, u: &mut [f64]) {
        let (whole, f) = split(scene.x());
        shift(u, whole);
        for t in (2..u.len()).rev() {
            // As differences from u(t): no fraction, no change, to the bit.
            u[t] += f * (2.0 - f) * (u[t - 1] - u[t]) + 0.5 * f * (f - 1.0) * (u[t - 2] - u[t]);
        }
    }
}

/// A delay of the input itself, `v'(t) = (1−f)·v(t−k) + f·v(t−k−1)`: of a sensor or a bus before the operator.
#[derive(Debug)]
struct ByPosition;

impl Law for ByPosition {
    card!("input_delay", "late position", Input, "samples", 4.0);

    fn injection(&self) -> Injection {
        Injection::Recording
    }

    fn recording(&self, scene: &mut Scene<'_>, v: &mut [f64]) {
        recorded_early(scene.x(), v);
    }

    fn drive(&self, scene: &mut Scene<'_>, v: &mut [f64]) {
        let (whole, part) = split(scene.x());
        shift(v, whole);
        for t in (1..v.len()).rev() {
            v[t] += part * (v[t - 1] - v[t]);
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

/// A record of the input that runs ahead of what acts by `d = k + f` samples: `v'(t) = (1−f)·v(t+k) + f·v(t+k+1)` while the input moves on;
/// where it rests or turns, the nearer of the two, since a part of a step would be a move of its own. The end is held.
fn recorded_early(delay: f64, v: &mut [f64]) {
    let (whole, part) = split(delay);
    let last = v.len() - 1;
    let acting = v.to_vec();
    let at = |t: usize| acting[t.min(last)];
    for (t, v) in v.iter_mut().enumerate().skip(1) {
        let [before, now, next] = [at(t + whole - 1), at(t + whole), at(t + whole + 1)];
        *v = match (now - before) * (next - now) > 0.0 {
            true => now + part * (next - now),
            false if part < 0.5 => now,
            false => next,
        };
    }
    v[0] = at(whole);
}
