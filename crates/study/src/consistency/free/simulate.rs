//! The output of one replicate, sample by sample.

use crate::consistency::direct::disturbed;
use crate::scenario::{Border, Case};
use switchback_noise::NoiseSamples;

/// A case's system and what each border makes of the drive.
#[derive(Debug)]
pub(super) struct Simulator {
    case: Case,
    /// `u` of each border.
    inputs: Vec<Vec<f64>>,
}

impl Simulator {
    pub(super) fn new(case: &Case, v: &[f64]) -> Self {
        let output = |border: &Border| border.hysteresis.output(v, border.hysteresis.u_low());
        Self { case: case.clone(), inputs: case.borders.iter().map(output).collect() }
    }

    /// The difference equation run with the noise in it: at rest at `h_m` while the noise settles, then over the drive.
    pub(super) fn output(&self, border: usize, sigma: f64, noise: &NoiseSamples) -> Vec<f64> {
        let before = self.case.borders[border].hysteresis.u_low();
        let mut u = vec![before; noise.burn_in];
        u.extend(&self.inputs[border]);
        let white: Vec<f64> = noise.w.iter().map(|w| sigma * w).collect();
        disturbed(&self.case, &u, &white, before).split_off(noise.burn_in)
    }
}
