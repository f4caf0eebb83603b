//! `rate_dependence`: the operator feels speed.

use super::card;
use super::motion::{half_width, last_moves, moves};
use crate::generate::law::{Law, Scene};

pub(super) static LAWS: [&dyn Law; 3] = [&Viscous, &PowerLaw, &WideningLoop];

/// Linear viscous friction: `u' = u + x·Δv`, nothing at rest.
#[derive(Debug)]
struct Viscous;

impl Law for Viscous {
    card!("rate_dependence", "viscous", Operator, "spans of u per width a sample", 20.0);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let moves = moves(scene.machine, v);
        u.iter_mut().zip(moves).for_each(|(u, speed)| *u += scene.amount.magnitude * speed);
    }
}

/// A power law, as of a magneto-rheological or shear-thinning fluid: `u' = u + x·sgn(Δv)·|Δv|^p`, p 0.3 to 0.7.
#[derive(Debug)]
struct PowerLaw;

impl Law for PowerLaw {
    card!("rate_dependence", "power law", Operator, "spans of u at a width a sample", 20.0);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let power = scene.amount.between(0, 0.3, 0.7);
        let moves = moves(scene.machine, v);
        let force = |speed: f64| if speed == 0.0 { 0.0 } else { speed.signum() * speed.abs().powf(power) };
        u.iter_mut().zip(moves).for_each(|(u, speed)| *u += scene.amount.magnitude * force(speed));
    }
}

/// The loop itself widens with speed and keeps its width at rest: half-width × `(1 + x·ln(1 + |Δv|/v₀))`.
#[derive(Debug)]
struct WideningLoop;

impl Law for WideningLoop {
    card!("rate_dependence", "widening loop", Operator, "half-widths of the loop", 5.0);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let reference = scene.amount.between(0, 0.01, 0.05);
        let speeds = last_moves(scene.machine, v);
        for t in 0..v.len() {
            let growth = scene.x() * (1.0 + speeds[t].abs() / reference).ln();
            let side = if speeds[t] == 0.0 { 0.0 } else { speeds[t].signum() };
            u[t] += growth * side * half_width(scene.machine, v[t]);
        }
    }
}
