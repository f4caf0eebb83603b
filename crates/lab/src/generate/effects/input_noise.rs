//! `input_noise`: what arrives is not what was commanded.

use super::card;
use super::motion::{border, directions};
use crate::generate::law::{INTERVAL_WIDTHS, Injection, Law, Nature, Scene};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

pub(super) static LAWS: [&dyn Law; 3] = [&PositionJitter, &ActuatorNoise, &LaplaceJitter];

/// Every move ends Gaussian-beside its target, the branch is the commanded one: `u = C(v + w)`, `w` kept at rest.
#[derive(Debug)]
struct PositionJitter;

impl Law for PositionJitter {
    card!("input_noise", "position jitter", Input, INTERVAL_WIDTHS, 0.2);

    fn injection(&self) -> Injection {
        Injection::Recording
    }

    fn recording(&self, scene: &mut Scene<'_>, v: &mut [f64]) {
        recorded_beside(scene, v, normal);
    }

    fn nature(&self) -> Nature {
        Nature::Noise
    }

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        jitter(scene, v, u, normal);
    }
}

/// White noise on `u` itself: `u' = u + w`.
#[derive(Debug)]
struct ActuatorNoise;

impl Law for ActuatorNoise {
    card!("input_noise", "actuator noise", Input, "spans of u", 2.0);

    fn nature(&self) -> Nature {
        Nature::Noise
    }

    fn dynamics(&self, scene: &mut Scene<'_>, u: &mut [f64]) {
        for now in u {
            let normal: f64 = StandardNormal.sample(&mut scene.rng);
            *now += scene.amount.magnitude * normal;
        }
    }
}

/// The same with Laplace-distributed misses: mostly close, now and then far.
#[derive(Debug)]
struct LaplaceJitter;

impl Law for LaplaceJitter {
    card!("input_noise", "Laplace jitter", Input, INTERVAL_WIDTHS, 0.2);

    fn injection(&self) -> Injection {
        Injection::Recording
    }

    fn recording(&self, scene: &mut Scene<'_>, v: &mut [f64]) {
        recorded_beside(scene, v, laplace);
    }

    fn nature(&self) -> Nature {
        Nature::Noise
    }

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        jitter(scene, v, u, laplace);
    }
}

fn jitter(scene: &mut Scene<'_>, v: &[f64], u: &mut [f64], unit: impl Fn(&mut ChaCha8Rng) -> f64) {
    let machine = scene.machine;
    let sd = scene.x() * machine.interval.width();
    let directions = directions(machine, v);
    let mut w = 0.0;
    for t in 1..v.len() {
        let miss = unit(&mut scene.rng);
        if v[t] != v[t - 1] {
            w = sd * miss;
        }
        u[t] += border(machine, directions[t], v[t] + w) - border(machine, directions[t], v[t]);
    }
}

/// A standard normal number.
fn normal(rng: &mut ChaCha8Rng) -> f64 {
    StandardNormal.sample(rng)
}

/// A number of the Laplace distribution with unit variance.
fn laplace(rng: &mut ChaCha8Rng) -> f64 {
    let p: f64 = rng.random_range(-0.5..0.5);
    -p.signum() * (1.0 - 2.0 * p.abs()).max(1e-12).ln() / 2.0_f64.sqrt()
}

/// A record of the input that misses what acts: `v' = v + w`, `w` drawn anew at every move and kept at rest.
fn recorded_beside(scene: &mut Scene<'_>, v: &mut [f64], unit: impl Fn(&mut ChaCha8Rng) -> f64) {
    let sd = scene.x() * scene.machine.interval.width();
    let (mut w, mut last) = (0.0, v[0]);
    for now in v {
        let miss = unit(&mut scene.rng);
        if *now != last {
            w = sd * miss;
        }
        last = *now;
        *now += w;
    }
}
