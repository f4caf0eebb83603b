//! A dozen kinds of inputs, as shares of the reach in `[0, 1]`.

use super::random::{log_uniform, one_of};
use crate::generate::field::drive::{Drive, ramp};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use std::f64::consts::TAU;

/// What drives the input.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum WideDrive {
    /// One of the field's.
    Field(Drive),
    /// Ramps between random levels, at speeds and with rests that vary.
    Walk,
    /// Noise behind one to three poles.
    FilteredNoise,
    /// Visits of a sample or two to random levels, from one end.
    Pulses,
    /// A sine whose amplitude varies slowly.
    Sine,
    /// Two sines.
    TwoTones,
    /// Full strokes at constant speed.
    Saw,
    /// Cycles that grow step by step, one to three of each size.
    GrowingProtocol,
}

impl WideDrive {
    pub(super) const ALL: [Self; 12] = [
        Self::Field(Drive::Multisine),
        Self::Field(Drive::RandomSteps),
        Self::Field(Drive::Triangle),
        Self::Field(Drive::SlowSweep),
        Self::Field(Drive::OperatingCycles),
        Self::Walk,
        Self::FilteredNoise,
        Self::Pulses,
        Self::Sine,
        Self::TwoTones,
        Self::Saw,
        Self::GrowingProtocol,
    ];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Field(drive) => drive.name(),
            Self::Walk => "walk",
            Self::FilteredNoise => "filtered-noise",
            Self::Pulses => "pulses",
            Self::Sine => "sine",
            Self::TwoTones => "two-tones",
            Self::Saw => "saw",
            Self::GrowingProtocol => "growing-protocol",
        }
    }

    /// So many samples of it; `period`, in samples, is what most of it takes there and back.
    pub(super) fn samples(self, samples: usize, period: f64, rng: &mut ChaCha8Rng) -> Vec<f64> {
        let mut z = match self {
            Self::Field(drive) => drive.samples(samples, period, rng),
            Self::Walk => walk(samples, period, rng),
            Self::FilteredNoise => filled(filtered_noise(samples, period, rng)),
            Self::Pulses => pulses(samples, period, rng),
            Self::Sine => filled(sine(samples, period, rng)),
            Self::TwoTones => filled(two_tones(samples, period, rng)),
            Self::Saw => saw(samples, period, rng),
            Self::GrowingProtocol => filled(growing_protocol(samples, period, rng)),
        };
        z.truncate(samples);
        z
    }
}

/// Scaled to fill `[0, 1]`.
fn filled(z: Vec<f64>) -> Vec<f64> {
    let (least, most) = z.iter().fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(*x), b.max(*x)));
    z.iter().map(|x| ((x - least) / (most - least).max(1e-12)).clamp(0.0, 1.0)).collect()
}

fn walk(samples: usize, period: f64, rng: &mut ChaCha8Rng) -> Vec<f64> {
    let rest = if rng.random_bool(0.6) { rng.random_range(0.0..0.5) } else { 0.0 };
    let varies = rng.random_bool(0.5);
    let mut z = vec![rng.random_range(0.0..1.0)];
    while z.len() < samples {
        let slower = if varies { log_uniform(rng, 0.3, 3.0) } else { 1.0 };
        ramp(&mut z, rng.random_range(0.0..1.0), period * slower, |share| share);
        let (last, hold) = (z[z.len() - 1], period * rest * rng.random::<f64>());
        z.extend(std::iter::repeat_n(last, hold as usize));
    }
    z
}

fn filtered_noise(samples: usize, period: f64, rng: &mut ChaCha8Rng) -> Vec<f64> {
    let pole = (-rng.random_range(2.0..12.0) / period).exp();
    let stages = rng.random_range(1..4);
    let mut w: Vec<f64> = StandardNormal.sample_iter(&mut *rng).take(samples + 200).collect();
    for _ in 0..stages {
        let mut state = 0.0;
        for now in &mut w {
            state = pole * state + (1.0 - pole) * *now;
            *now = state;
        }
    }
    w.split_off(200)
}

fn pulses(samples: usize, period: f64, rng: &mut ChaCha8Rng) -> Vec<f64> {
    let end = if rng.random_bool(0.5) { 0.0 } else { 1.0 };
    let levels = rng.random_range(4..10);
    let mut z = Vec::new();
    while z.len() < samples {
        z.extend(std::iter::repeat_n(end, (0.3 * period) as usize + 1));
        let level = f64::from(rng.random_range(0..=levels)) / f64::from(levels);
        z.extend(std::iter::repeat_n(level, rng.random_range(1..3)));
    }
    z
}

fn sine(samples: usize, period: f64, rng: &mut ChaCha8Rng) -> Vec<f64> {
    let (depth, slow) = (rng.random_range(0.0..0.8), period * rng.random_range(3.0..12.0));
    let (p, q) = (rng.random_range(0.0..TAU), rng.random_range(0.0..TAU));
    let at = |t: f64| (1.0 + depth * (TAU * t / slow + p).sin()) * (TAU * t / period + q).sin();
    (0..samples).map(|t| at(t as f64)).collect()
}

fn two_tones(samples: usize, period: f64, rng: &mut ChaCha8Rng) -> Vec<f64> {
    let (height, ratio) = (rng.random_range(0.2..1.0), rng.random_range(1.5..6.0));
    let phase = rng.random_range(0.0..TAU);
    let at = |t: f64| (TAU * t / period).sin() + height * (TAU * ratio * t / period + phase).sin();
    (0..samples).map(|t| at(t as f64)).collect()
}

fn saw(samples: usize, period: f64, rng: &mut ChaCha8Rng) -> Vec<f64> {
    let mut z = vec![0.0];
    let mut end = 1.0;
    while z.len() < samples {
        let short: f64 = rng.random_range(0.0..0.08);
        let stroke = if end > 0.5 { 1.0 - short } else { short };
        let target = if rng.random_bool(0.85) { stroke } else { rng.random() };
        ramp(&mut z, target, period, |share| share);
        end = 1.0 - end;
    }
    z
}

fn growing_protocol(samples: usize, period: f64, rng: &mut ChaCha8Rng) -> Vec<f64> {
    let (repeats, sizes) = (rng.random_range(1..4), rng.random_range(4..10));
    let power = rng.random_range(0.8..1.3);
    let is_sine = rng.random_bool(0.5);
    let same_speed = rng.random_bool(0.5);
    let mut z = Vec::new();
    let mut k = 0;
    while z.len() < samples {
        k = k % sizes + 1;
        let size = (f64::from(k) / f64::from(sizes)).powf(power);
        let length = (period * if same_speed { size } else { 1.0 }).max(8.0) as usize;
        for t in 0..length * repeats {
            let wave = (TAU * t as f64 / length as f64).sin();
            z.push(size * if is_sine { wave } else { wave.asin() * 2.0 / std::f64::consts::PI });
        }
        if rng.random_bool(0.1) {
            k = one_of(rng, &[0, sizes / 2]);
        }
    }
    z
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn every_drive_stays_in_reach_moves_and_has_the_length_asked_for() {
        for (seed, drive) in (0..).zip(WideDrive::ALL) {
            for period in [12.0, 60.0, 400.0] {
                let z = drive.samples(700, period, &mut ChaCha8Rng::seed_from_u64(seed));
                assert_eq!(z.len(), 700, "{}", drive.name());
                assert!(z.iter().all(|x| (0.0..=1.0).contains(x)), "{}", drive.name());
                assert!(z.windows(2).any(|w| w[0] != w[1]), "{}", drive.name());
            }
        }
    }
}
