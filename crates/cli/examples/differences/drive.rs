//! Inputs, noise and rigs that all simulators beside machines share.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::Rng;
use std::f64::consts::TAU;
use switchback_model::Record;
use switchback_model::rig::{Rig, RigRecord, Role, Usage};

pub(super) fn uniform(rng: &mut ChaCha8Rng, low: f64, high: f64) -> f64 {
    low + (high - low) * (rng.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
}

/// Adds normal noise, nearly: a sum of twelve uniform numbers, of a standard deviation over that of the signal.
pub(super) fn add_noise(y: &mut [f64], ratio: f64, rng: &mut ChaCha8Rng) {
    let mean = y.iter().sum::<f64>() / y.len() as f64;
    let sd = (y.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / y.len() as f64).sqrt();
    for y in y {
        let normal: f64 = (0..12).map(|_| uniform(rng, 0.0, 1.0)).sum::<f64>() - 6.0;
        *y += ratio * sd * normal;
    }
}

/// Ten sines between 0.1 and 4 Hz, slower ones larger.
pub(super) struct Drive {
    /// `[amplitude, frequency, phase]`.
    sines: Vec<[f64; 3]>,
    /// Samples a second.
    rate: f64,
    samples: usize,
}

impl Drive {
    /// Sines that reach so far to one side.
    pub(super) fn draw(rng: &mut ChaCha8Rng, (rate, samples): (f64, usize), reach: f64) -> Self {
        let sine = |k: i32| {
            let f = 0.1 * 40_f64.powf((f64::from(k) + uniform(rng, 0.0, 1.0)) / 10.0);
            [f.powf(-0.7), f, uniform(rng, 0.0, TAU)]
        };
        let mut drive = Self { sines: (0..10).map(sine).collect(), rate, samples };
        let most = (0..samples).map(|t| drive.at(t)[0].abs()).fold(0.0, f64::max);
        drive.sines.iter_mut().for_each(|sine| sine[0] *= reach / most);
        drive
    }

    /// Position, speed and acceleration at a sample.
    pub(super) fn at(&self, sample: usize) -> [f64; 3] {
        let t = sample as f64 / self.rate;
        self.sines.iter().fold([0.0; 3], |[x, v, a], [amplitude, f, phase]| {
            let (omega, angle) = (TAU * f, TAU * f * t + phase);
            [
                x + amplitude * angle.sin(),
                v + amplitude * omega * angle.cos(),
                a - amplitude * omega * omega * angle.sin(),
            ]
        })
    }

    /// A rig of one record with the predictions of a simulator; its last third is held out.
    pub(super) fn rig(&self, name: &str, labels: [&str; 2], y: Vec<f64>, predicted: Vec<f64>) -> Rig {
        let v: Vec<f64> = (0..self.samples).map(|t| self.at(t)[0]).collect();
        let cut = self.samples - self.samples / 3;
        let record = |name: &str, usage, part: std::ops::Range<usize>| RigRecord {
            name: name.to_owned(),
            role: Role::Free,
            usage,
            record: Record::new(v[part.clone()].to_vec(), y[part.clone()].to_vec())
                .expect("finite and equally long"),
            predicted: Some(predicted[part].to_vec()),
        };
        Rig {
            name: name.to_owned(),
            sample_time: 1.0 / self.rate,
            order: None,
            interval: None,
            input_label: labels[0].to_owned(),
            output_label: labels[1].to_owned(),
            records: vec![
                record("first two thirds", Usage::Fit, 0..cut),
                record("last third", Usage::Holdout, cut..self.samples),
            ],
        }
    }
}
