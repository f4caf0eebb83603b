//! `backlash`: a reversal must first cross a gap.

use super::card;
use super::motion::position;
use crate::law::{Law, Scene};

pub(super) static LAWS: [&dyn Law; 3] = [&Play, &PrandtlIshlinskii, &UnevenPlay];

/// Shorter than this, in widths, the effect falls between the samples of a moving input.
const SHORTEST: f64 = 0.01;

/// The play operator: `v'(t) = min(max(v'(t−1), v(t) − r), v(t) + r)`.
#[derive(Debug)]
struct Play;

impl Law for Play {
    card!("backlash", "play", Operator, "interval widths", 0.2);

    fn least(&self) -> f64 {
        SHORTEST
    }

    fn drive(&self, scene: &mut Scene<'_>, v: &mut [f64]) {
        let radius = scene.x() * scene.plant.interval.width();
        play(v, |_| radius);
    }
}

/// Five plays abreast, radii 0.6 to 1.4 of the mean, as of gear teeth that engage one by one (Prandtl–Ishlinskii).
#[derive(Debug)]
struct PrandtlIshlinskii;

impl Law for PrandtlIshlinskii {
    card!("backlash", "Prandtl-Ishlinskii", Operator, "interval widths", 0.15);

    fn least(&self) -> f64 {
        SHORTEST
    }

    fn drive(&self, scene: &mut Scene<'_>, v: &mut [f64]) {
        if scene.x() == 0.0 {
            return; // a mean of five equal values need not be that value to the bit
        }
        let mut sum = vec![0.0; v.len()];
        for k in 0..5 {
            let radius = scene.x() * scene.plant.interval.width() * (0.6 + 0.2 * f64::from(k));
            let mut one = v.to_vec();
            play(&mut one, |_| radius);
            sum.iter_mut().zip(one).for_each(|(s, v)| *s += v);
        }
        // The parts that stand still together must give a sum that stands still to the bit: they do.
        v.iter_mut().zip(sum).for_each(|(v, s)| *v = s / 5.0);
    }
}

/// A play whose gap differs along the stroke, by up to 70 %.
#[derive(Debug)]
struct UnevenPlay;

impl Law for UnevenPlay {
    card!("backlash", "uneven play", Operator, "interval widths", 0.15);

    fn least(&self) -> f64 {
        SHORTEST
    }

    fn drive(&self, scene: &mut Scene<'_>, v: &mut [f64]) {
        let plant = scene.plant;
        let mean = scene.x() * plant.interval.width();
        let phase = scene.dose.between(0, 0.0, std::f64::consts::TAU);
        play(v, |v| mean * (1.0 + 0.7 * (5.0 * position(plant, v) + phase).sin()));
    }
}

fn play(v: &mut [f64], radius: impl Fn(f64) -> f64) {
    let mut held = v[0];
    for now in v {
        let r = radius(*now);
        held = held.max(*now - r).min(*now + r);
        *now = held;
    }
}
