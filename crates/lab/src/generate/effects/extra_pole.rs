//! `extra_pole`: something between operator and machine lags.

use super::card;
use crate::generate::law::{Law, Scene};

pub(super) static LAWS: [&dyn Law; 3] = [&Lag, &DoubleLag, &LagWithFeedthrough];

/// `u'(t) = p·u'(t−1) + (1−p)·u(t)`.
#[derive(Debug)]
struct Lag;

impl Law for Lag {
    card!("extra_pole", "first-order lag", Dynamics, "pole", 0.97);

    fn dynamics(&self, scene: &mut Scene<'_>, u: &mut [f64]) {
        lag(scene.x(), u);
    }
}

/// Two equal poles.
#[derive(Debug)]
struct DoubleLag;

impl Law for DoubleLag {
    card!("extra_pole", "double lag", Dynamics, "pole", 0.95);

    fn dynamics(&self, scene: &mut Scene<'_>, u: &mut [f64]) {
        lag(scene.x(), u);
        lag(scene.x(), u);
    }
}

/// A lag that 20 to 60 % of `u` bypasses: a pole and a zero.
#[derive(Debug)]
struct LagWithFeedthrough;

impl Law for LagWithFeedthrough {
    card!("extra_pole", "lag with feedthrough", Dynamics, "pole", 0.97);

    fn dynamics(&self, scene: &mut Scene<'_>, u: &mut [f64]) {
        let share = scene.amount.between(0, 0.4, 0.8);
        let mut lagged = u.to_vec();
        lag(scene.x(), &mut lagged);
        u.iter_mut().zip(lagged).for_each(|(u, l)| *u += share * (l - *u));
    }
}

fn lag(pole: f64, u: &mut [f64]) {
    let mut state = u[0];
    for now in u {
        // Written as a deviation, so that a pole at zero returns `u` to the bit.
        *now += pole * (state - *now);
        state = *now;
    }
}
