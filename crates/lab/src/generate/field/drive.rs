//! Inputs as datasets in the field have them, as shares of the reach in `[0, 1]`.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::{PI, TAU};

/// What drives the input through a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Drive {
    /// A sum of 8 to 20 sines of random frequencies and phases.
    Multisine,
    /// Random levels, reached at once and held.
    RandomSteps,
    /// A triangle whose amplitude varies from one half-wave to the next, at constant speed.
    Triangle,
    /// A sine whose frequency rises slowly.
    SlowSweep,
    /// The same few positions in turn, with rests there.
    OperatingCycles,
}

impl Drive {
    pub(crate) const ALL: [Self; 5] =
        [Self::Multisine, Self::RandomSteps, Self::Triangle, Self::SlowSweep, Self::OperatingCycles];

    /// Those that come by every place again and again.
    pub(super) const THOROUGH: [Self; 3] = [Self::Multisine, Self::Triangle, Self::SlowSweep];

    /// The name of a record with it.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Multisine => "multisine",
            Self::RandomSteps => "random-steps",
            Self::Triangle => "triangle",
            Self::SlowSweep => "slow-sweep",
            Self::OperatingCycles => "cycles",
        }
    }

    /// So many samples of it; `period`, in samples, is what most of it takes there and back.
    pub(crate) fn samples(self, samples: usize, period: f64, rng: &mut ChaCha8Rng) -> Vec<f64> {
        let mut z = match self {
            Self::Multisine => multisine(samples, period, rng),
            Self::RandomSteps => random_steps(samples, period, rng),
            Self::Triangle => triangle(samples, period, rng),
            Self::SlowSweep => slow_sweep(samples, period, rng),
            Self::OperatingCycles => operating_cycles(samples, period, rng),
        };
        z.truncate(samples);
        z
    }
}

/// Frequencies from a quarter of `1/period` to twice that, scaled to fill the reach.
fn multisine(samples: usize, period: f64, rng: &mut ChaCha8Rng) -> Vec<f64> {
    let lines: Vec<(f64, f64)> = (0..rng.random_range(8..=20))
        .map(|_| (rng.random_range(0.25..2.0) / period, rng.random_range(0.0..TAU)))
        .collect();
    let at = |t: usize| lines.iter().map(|(f, phase)| (TAU * f * t as f64 + phase).sin()).sum::<f64>();
    let sum: Vec<f64> = (0..samples).map(at).collect();
    let least = sum.iter().copied().fold(f64::INFINITY, f64::min);
    let most = sum.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    sum.iter().map(|x| ((x - least) / (most - least)).clamp(0.0, 1.0)).collect()
}

/// Levels held for a quarter of a period to a whole one.
fn random_steps(samples: usize, period: f64, rng: &mut ChaCha8Rng) -> Vec<f64> {
    let mut z = Vec::with_capacity(samples);
    while z.len() < samples {
        let hold = (period * rng.random_range(0.25..1.0)).ceil() as usize;
        z.extend(std::iter::repeat_n(rng.random_range(0.0..1.0), hold));
    }
    z
}

/// Half-waves of 0.2 to all of the amplitude; the reach and back takes a period.
fn triangle(samples: usize, period: f64, rng: &mut ChaCha8Rng) -> Vec<f64> {
    let (mut z, mut side) = (vec![0.5], 0.5);
    while z.len() < samples {
        let target = 0.5 + side * rng.random_range(0.2..1.0);
        ramp(&mut z, target, period, |share| share);
        side = -side;
    }
    z
}

/// From a quarter of `1/period` to twice that, at equal ratios in equal times.
fn slow_sweep(samples: usize, period: f64, rng: &mut ChaCha8Rng) -> Vec<f64> {
    let mut phase = rng.random_range(0.0..TAU);
    (0..samples)
        .map(|t| {
            phase += TAU * 0.25 / period * 8.0_f64.powf(t as f64 / samples as f64);
            0.5 + 0.5 * phase.sin()
        })
        .collect()
}

/// Three to five positions, missed by up to 2 % of the reach, with rests of 0.05 to 0.4 periods.
fn operating_cycles(samples: usize, period: f64, rng: &mut ChaCha8Rng) -> Vec<f64> {
    let positions: Vec<f64> = (0..rng.random_range(3..=5)).map(|_| rng.random_range(0.0..1.0)).collect();
    let mut z = vec![positions[0]];
    for position in positions.iter().cycle().skip(1) {
        if z.len() >= samples {
            break;
        }
        let target = (position + rng.random_range(-0.02..0.02_f64)).clamp(0.0, 1.0);
        ramp(&mut z, target, period, |share| 0.5 - 0.5 * (PI * share).cos());
        let rest = (period * rng.random_range(0.05..0.4)).ceil() as usize;
        z.extend(std::iter::repeat_n(target, rest));
    }
    z
}

/// Moves on to a target at two reaches a period, and arrives there to the bit: a rest must not move.
pub(crate) fn ramp(z: &mut Vec<f64>, target: f64, period: f64, course: impl Fn(f64) -> f64) {
    let from = z[z.len() - 1];
    let duration = (0.5 * period * (target - from).abs()).ceil().max(1.0) as usize;
    z.extend((1..duration).map(|k| from + (target - from) * course(k as f64 / duration as f64)));
    z.push(target);
}
