//! `backlash`: a reversal must first cross a gap.
//!
//! Its magnitude is the full width of the gap, the travel lost at a reversal: twice the radius of the play operator.

use super::card;
use super::motion::position;
use crate::generate::law::{INTERVAL_WIDTHS, Law, Scene};

pub(super) static LAWS: [&dyn Law; 3] = [&Play, &PrandtlIshlinskii, &UnevenPlay];

/// What its magnitude is.
const QUANTITY: &str = "full width";

/// A gap narrower than this, in interval widths, falls between the samples of a moving input.
const NARROWEST: f64 = 0.02;

/// The play operator: `v'(t) = min(max(v'(t−1), v(t) − x/2), v(t) + x/2)`.
#[derive(Debug)]
struct Play;

impl Law for Play {
    card!("backlash", "play", Operator, INTERVAL_WIDTHS, 0.4);

    fn quantity(&self) -> Option<&'static str> {
        Some(QUANTITY)
    }

    fn least(&self) -> f64 {
        NARROWEST
    }

    fn drive(&self, scene: &mut Scene<'_>, v: &mut [f64]) {
        let width = scene.x() * scene.machine.interval.width();
        play(v, |_| width);
    }
}

/// Five plays abreast, widths 0.6 to 1.4 of the mean, as of gear teeth that engage one by one (Prandtl–Ishlinskii).
#[derive(Debug)]
struct PrandtlIshlinskii;

impl Law for PrandtlIshlinskii {
    card!("backlash", "Prandtl-Ishlinskii", Operator, INTERVAL_WIDTHS, 0.3);

    fn quantity(&self) -> Option<&'static str> {
        Some(QUANTITY)
    }

    fn least(&self) -> f64 {
        NARROWEST
    }

    fn drive(&self, scene: &mut Scene<'_>, v: &mut [f64]) {
        if scene.x() == 0.0 {
            return; // a mean of five equal values need not be that value to the bit
        }
        let mut sum = vec![0.0; v.len()];
        for k in 0..5 {
            let width = scene.x() * scene.machine.interval.width() * (0.6 + 0.2 * f64::from(k));
            let mut one = v.to_vec();
            play(&mut one, |_| width);
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
    card!("backlash", "uneven play", Operator, INTERVAL_WIDTHS, 0.3);

    fn quantity(&self) -> Option<&'static str> {
        Some(QUANTITY)
    }

    fn least(&self) -> f64 {
        NARROWEST
    }

    fn drive(&self, scene: &mut Scene<'_>, v: &mut [f64]) {
        let machine = scene.machine;
        let mean = scene.x() * machine.interval.width();
        let phase = scene.amount.between(0, 0.0, std::f64::consts::TAU);
        play(v, |v| mean * (1.0 + 0.7 * (5.0 * position(machine, v) + phase).sin()));
    }
}

/// The play operator with a full width that may depend on where the input is.
fn play(v: &mut [f64], width: impl Fn(f64) -> f64) {
    let mut held = v[0];
    for now in v {
        let half = 0.5 * width(*now);
        held = held.max(*now - half).min(*now + half);
        *now = held;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reversal_loses_the_full_width() {
        // Up to 1, then down by steps of 0.05: nothing moves until the gap of 0.4 is crossed.
        let mut v: Vec<f64> = (0..=20).map(|k| 0.05 * f64::from(k)).collect();
        v.extend((1..=20).map(|k| 1.0 - 0.05 * f64::from(k)));
        let commanded = v.clone();
        play(&mut v, |_| 0.4);
        let moved = (21..v.len()).find(|&t| v[t] < v[20] - 1e-9).expect("it moves in the end");
        assert!((commanded[20] - commanded[moved] - 0.45).abs() < 1e-9, "{}", commanded[moved]);
    }
}
