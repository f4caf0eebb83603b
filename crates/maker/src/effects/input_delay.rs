//! `input_delay`: the actuator answers late.

use super::card;
use crate::law::{Law, Scene};

pub(super) static LAWS: [&dyn Law; 2] = [&HeldCommand, &AllPass];

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

/// The fractional part by a first-order all-pass (Thiran): `u'(t) = c·u(t) + u(t−1) − c·u'(t−1)`, `c = (1−f)/(1+f)`.
#[derive(Debug)]
struct AllPass;

impl Law for AllPass {
    card!("input_delay", "all-pass", Input, "samples", 4.0);

    fn dynamics(&self, scene: &mut Scene<'_>, u: &mut [f64]) {
        let (whole, part) = split(scene.x());
        shift(u, whole);
        if part == 0.0 {
            return;
        }
        let c = (1.0 - part) / (1.0 + part);
        let (mut before, mut answer) = (u[0], u[0]);
        for now in u.iter_mut() {
            answer = c * *now + before - c * answer;
            before = *now;
            *now = answer;
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
