//! `periodic_disturbance`: something nearby turns or hums.

use super::card;
use crate::generate::law::{Amount, Law, Scene};
use std::f64::consts::TAU;

pub(super) static LAWS: [&dyn Law; 4] = [&Sine, &SquareWave, &TwoLines, &OutputHum];

/// `ξ' = ξ + x·σ·sin(2πft + φ)`, f 0.004 to 0.4 of the sampling rate, one phase for the whole dataset.
#[derive(Debug)]
struct Sine;

impl Law for Sine {
    card!("periodic_disturbance", "sine", Disturbance, "noise sd", 100.0);

    fn equation_error(&self, scene: &mut Scene<'_>, _u: &[f64], xi: &mut [f64]) {
        add(scene, xi, |amount, t| phase(amount, 0, t).sin());
    }
}

/// A square wave, as of a compressor that switches on and off.
#[derive(Debug)]
struct SquareWave;

impl Law for SquareWave {
    card!("periodic_disturbance", "square wave", Disturbance, "noise sd", 100.0);

    fn equation_error(&self, scene: &mut Scene<'_>, _u: &[f64], xi: &mut [f64]) {
        add(scene, xi, |amount, t| if phase(amount, 0, t).sin() > 0.0 { 1.0 } else { -1.0 });
    }
}

/// Two sines whose frequencies have no common period.
#[derive(Debug)]
struct TwoLines;

impl Law for TwoLines {
    card!("periodic_disturbance", "two lines", Disturbance, "noise sd", 100.0);

    fn equation_error(&self, scene: &mut Scene<'_>, _u: &[f64], xi: &mut [f64]) {
        add(scene, xi, |amount, t| phase(amount, 0, t).sin() + 0.7 * phase(amount, 2, t).sin());
    }
}

/// A sine on the recorded output, as of mains hum in the cable.
#[derive(Debug)]
struct OutputHum;

impl Law for OutputHum {
    card!("periodic_disturbance", "hum on the output", Disturbance, "noise sd", 100.0);

    fn sensor(&self, scene: &mut Scene<'_>, y: &mut [f64]) {
        add(scene, y, |amount, t| phase(amount, 0, t).sin());
    }
}

fn phase(amount: &Amount, i: usize, t: f64) -> f64 {
    let frequency = 0.004 * 100.0_f64.powf(amount.shape[i]);
    TAU * (frequency * t + amount.shape[1])
}

fn add(scene: &Scene<'_>, signal: &mut [f64], wave: impl Fn(&Amount, f64) -> f64) {
    let scale = scene.x() * scene.machine.noise_sd;
    for (t, now) in signal.iter_mut().enumerate() {
        *now += scale * wave(&scene.amount, (scene.passage.start + t) as f64);
    }
}
