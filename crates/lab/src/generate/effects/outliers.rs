//! `outliers`: a few samples are far off.

use super::card;
use crate::generate::law::{Law, Nature, Scene};
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal, StudentT};

pub(super) static LAWS: [&dyn Law; 4] = [&Contaminated, &StudentTails, &Bursts, &Spikes];

/// Tukey's contaminated normal in the equation error: 0.4 to 2 % of the samples get `x·σ·N(0, 1)` besides.
#[derive(Debug)]
struct Contaminated;

impl Law for Contaminated {
    card!("outliers", "contaminated normal", Disturbance, "noise sd", 500.0);

    fn nature(&self) -> Nature {
        Nature::Noise
    }

    fn equation_error(&self, scene: &mut Scene<'_>, _u: &[f64], xi: &mut [f64]) {
        contaminate(scene, xi);
    }
}

/// The tails of a Student t with two degrees of freedom: draws beyond 5 are added, times `x·σ`, the rest is not.
#[derive(Debug)]
struct StudentTails;

impl Law for StudentTails {
    card!("outliers", "Student tails", Disturbance, "noise sd", 100.0);

    fn nature(&self) -> Nature {
        Nature::Noise
    }

    fn equation_error(&self, scene: &mut Scene<'_>, _u: &[f64], xi: &mut [f64]) {
        let scale = scene.x() * scene.machine.noise_sd;
        let student = StudentT::new(2.0).expect("two degrees of freedom");
        for now in xi {
            let draw: f64 = student.sample(&mut scene.rng);
            if draw.abs() > 5.0 {
                // Cut where a sensor would trip, so that one draw cannot carry the whole rig.
                *now += scale * draw.clamp(-40.0, 40.0);
            }
        }
    }
}

/// Outliers that come in bursts of 2 to 6 samples, one burst in 400 samples.
#[derive(Debug)]
struct Bursts;

impl Law for Bursts {
    card!("outliers", "bursts", Disturbance, "noise sd", 500.0);

    fn nature(&self) -> Nature {
        Nature::Noise
    }

    fn equation_error(&self, scene: &mut Scene<'_>, _u: &[f64], xi: &mut [f64]) {
        let sd = scene.x() * scene.machine.noise_sd;
        let mut left = 0;
        for now in xi {
            if left == 0 && scene.rng.random_bool(1.0 / 400.0) {
                left = scene.rng.random_range(2..=6);
            }
            if left > 0 {
                let normal: f64 = StandardNormal.sample(&mut scene.rng);
                *now += sd * normal;
                left -= 1;
            }
        }
    }
}

/// Spikes in the reading: the same contamination on the recorded output, which the dynamics never see.
#[derive(Debug)]
struct Spikes;

impl Law for Spikes {
    card!("outliers", "reading spikes", Disturbance, "noise sd", 500.0);

    fn nature(&self) -> Nature {
        Nature::Noise
    }

    fn sensor(&self, scene: &mut Scene<'_>, y: &mut [f64]) {
        contaminate(scene, y);
    }
}

fn contaminate(scene: &mut Scene<'_>, signal: &mut [f64]) {
    let sd = scene.x() * scene.machine.noise_sd;
    let share = scene.amount.between(0, 0.004, 0.02);
    for now in signal {
        let normal: f64 = StandardNormal.sample(&mut scene.rng);
        if scene.rng.random_bool(share) {
            *now += sd * normal;
        }
    }
}
