//! Noise of many colours on the output, and what a recorder makes of the input.

use crate::generate::effects::card;
use crate::generate::law::{INTERVAL_WIDTHS, Injection, Law, Nature, Scene};
use crate::generate::machine::{amplification, multiply};
use rand_distr::{Distribution, StandardNormal};

/// Coloured noise of standard deviation `x` on the output: white, one pole, two poles, a moving average, slow beside white, or resonant.
#[derive(Debug)]
pub(super) struct ManyColours;

/// Samples before a record, so that slow noise is stationary when it begins.
const RUN_IN: usize = 400;

impl Law for ManyColours {
    card!("coloured_noise", "many colours", Disturbance, "output units", 1e9);

    fn nature(&self) -> Nature {
        Nature::Noise
    }

    fn sensor(&self, scene: &mut Scene<'_>, y: &mut [f64]) {
        let mut normals = StandardNormal.sample_iter(&mut scene.rng);
        let white: Vec<f64> = normals.by_ref().take(y.len() + RUN_IN).collect();
        let amount = &scene.amount;
        let (kind, part) = (6.0 * amount.shape[0], (6.0 * amount.shape[0]).fract());
        let noise = match kind as usize {
            0 => white,
            1 => behind(&[1.0, -pole(0.4 * 100.0_f64.powf(amount.shape[1]))], &white),
            2 => {
                let slow = pole(0.3 * 80.0_f64.powf(amount.shape[1]));
                let other = slow * amount.between(2, -0.4, 0.8);
                behind(&multiply(&[1.0, -slow], &[1.0, -other]), &white)
            }
            3 => moving_average(&white, 2 + (8.0 * amount.shape[1]) as usize),
            4 => {
                let slow: Vec<f64> = normals.take(white.len()).collect();
                let slow = behind(&[1.0, -pole(20.0 * 15.0_f64.powf(amount.shape[1]))], &slow);
                let weight = 0.3 * 16.0_f64.powf(part);
                let scale = (1.0 + weight * weight).sqrt();
                white.iter().zip(slow).map(|(w, s)| (w + weight * s) / scale).collect()
            }
            _ => {
                let (radius, angle) = (amount.between(1, 0.8, 0.985), amount.between(2, 0.05, 2.2));
                behind(&[1.0, -2.0 * radius * f64::cos(angle), radius * radius], &white)
            }
        };
        for (now, w) in y.iter_mut().zip(&noise[RUN_IN..]) {
            *now += scene.amount.magnitude * w;
        }
    }
}

fn pole(time_constant: f64) -> f64 {
    (-1.0 / time_constant).exp()
}

/// White noise behind `1/D`, of unit variance.
fn behind(d: &[f64], white: &[f64]) -> Vec<f64> {
    let scale = 1.0 / amplification(&d[1..]);
    let mut e: Vec<f64> = Vec::with_capacity(white.len());
    for (t, w) in white.iter().enumerate() {
        let past: f64 = (1..d.len().min(t + 1)).map(|i| d[i] * e[t - i]).sum();
        e.push(w - past);
    }
    e.into_iter().map(|e| scale * e).collect()
}

fn moving_average(white: &[f64], length: usize) -> Vec<f64> {
    let scale = 1.0 / (length as f64).sqrt();
    (0..white.len()).map(|t| scale * white[t.saturating_sub(length - 1)..=t].iter().sum::<f64>()).collect()
}

/// The record of the input is rounded to steps of `x`.
#[derive(Debug)]
pub(super) struct RoundedInput;

impl Law for RoundedInput {
    card!("input_noise", "rounding of the input's record", Input, INTERVAL_WIDTHS, 0.1);

    fn nature(&self) -> Nature {
        Nature::Noise
    }

    fn injection(&self) -> Injection {
        Injection::Recording
    }

    fn recording(&self, scene: &mut Scene<'_>, v: &mut [f64]) {
        let step = scene.x() * scene.machine.interval.width();
        if step > 0.0 {
            v.iter_mut().for_each(|v| *v = step * (*v / step).round());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::Passage;
    use crate::generate::law::Amount;
    use crate::generate::machine::{Family, Machine};
    use crate::generate::stream::{Purpose, stream};
    use switchback_model::rig::{Role, Usage};

    #[test]
    fn noise_of_every_colour_has_the_standard_deviation_asked_for() {
        let machine = Machine::draw(Family { order: Some(1), shape: None }, &mut stream(1, Purpose::Machine));
        let passage =
            Passage::of(0, "r".to_owned(), (Role::Free, Usage::Fit), (vec![0.0], vec![0.0; 60_000]));
        for kind in 0..6 {
            for rest in [0.1, 0.6] {
                let shape = [(f64::from(kind) + 0.3) / 6.0, rest, 0.4, 0.2];
                let amount = Amount { magnitude: 2.0, shape };
                let rng = stream(9, Purpose::Noise(kind as usize));
                let mut y = vec![0.0; 60_000];
                ManyColours.sensor(&mut Scene { machine: &machine, passage: &passage, amount, rng }, &mut y);
                let sd = (y.iter().map(|x| x * x).sum::<f64>() / y.len() as f64).sqrt();
                assert!((sd / 2.0 - 1.0).abs() < 0.15, "{kind} {rest}: {sd}");
            }
        }
    }
}
