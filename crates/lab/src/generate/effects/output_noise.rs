//! `output_noise`: white noise on the output, besides the equation error.

use super::card;
use crate::generate::law::{Amount, Law, Nature, Scene};
use crate::generate::machine::Machine;
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};
use std::f64::consts::PI;

pub(super) static LAWS: [&dyn Law; 2] = [&Gaussian, &Uniform];

/// Laws that examinations do not draw.
pub(super) static FURTHER_LAWS: [&dyn Law; 1] = [&Quiet];

/// `y' = y + w`, `w` white Gaussian of sd `x·σ`.
#[derive(Debug)]
struct Gaussian;

impl Law for Gaussian {
    card!("output_noise", "Gaussian", Disturbance, "noise sd", 300.0);

    fn nature(&self) -> Nature {
        Nature::Noise
    }

    fn oracle_variance(&self, machine: &Machine, amount: &Amount) -> f64 {
        innovations_variance(machine, amount.magnitude)
    }

    fn sensor(&self, scene: &mut Scene<'_>, y: &mut [f64]) {
        let sd = scene.x() * scene.machine.noise_sd;
        for now in y {
            let normal: f64 = StandardNormal.sample(&mut scene.rng);
            *now += sd * normal;
        }
    }
}

/// The same with `w` uniform, as of a dithered converter.
#[derive(Debug)]
struct Uniform;

impl Law for Uniform {
    card!("output_noise", "uniform", Disturbance, "noise sd", 300.0);

    fn nature(&self) -> Nature {
        Nature::Noise
    }

    fn oracle_variance(&self, machine: &Machine, amount: &Amount) -> f64 {
        innovations_variance(machine, amount.magnitude)
    }

    fn sensor(&self, scene: &mut Scene<'_>, y: &mut [f64]) {
        let half = 3.0_f64.sqrt() * scene.x() * scene.machine.noise_sd;
        for now in y {
            *now += half * scene.rng.random_range(-1.0..1.0);
        }
    }
}

/// The same with `w` a Gaussian whose sd is 1.3 for a half of the dataset and 0.56 for the other: unit variance on the whole.
#[derive(Debug)]
struct Quiet;

impl Law for Quiet {
    card!("output_noise", "loud and quiet halves", Disturbance, "noise sd", 300.0);

    fn nature(&self) -> Nature {
        Nature::Noise
    }

    fn oracle_variance(&self, machine: &Machine, amount: &Amount) -> f64 {
        innovations_variance(machine, amount.magnitude)
    }

    fn sensor(&self, scene: &mut Scene<'_>, y: &mut [f64]) {
        let sd = scene.x() * scene.machine.noise_sd;
        let first = scene.amount.sign(0) > 0.0;
        for (t, now) in y.iter_mut().enumerate() {
            let normal: f64 = StandardNormal.sample(&mut scene.rng);
            let loud = (scene.passage.clock(t) < 0.5) == first;
            *now += sd * normal * if loud { 1.3 } else { 0.31_f64.sqrt() };
        }
    }
}

/// One-step variance of `ξ/A + w` over that of ξ, by Kolmogorov and Szegő: `exp(mean over ω of ln(|A|⁻² + x²))`.
fn innovations_variance(machine: &Machine, x: f64) -> f64 {
    const POINTS: usize = 512;
    let log_spectrum = (0..POINTS).map(|k| {
        let omega = PI * (k as f64 + 0.5) / POINTS as f64;
        let (mut re, mut im) = (1.0, 0.0);
        for (i, a) in machine.a.iter().enumerate() {
            re += a * (omega * (i + 1) as f64).cos();
            im -= a * (omega * (i + 1) as f64).sin();
        }
        (1.0 / (re * re + im * im) + x * x).ln()
    });
    if x == 0.0 { 1.0 } else { (log_spectrum.sum::<f64>() / POINTS as f64).exp() }
}
