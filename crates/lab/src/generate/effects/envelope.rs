//! How slow effects run over a dataset.

use crate::generate::law::Amount;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use std::f64::consts::TAU;

/// A slow course over the dataset, of order one. `clock` runs from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Envelope {
    /// A straight line from −1/2 to 1/2.
    Ramp,
    /// An exponential approach, as of a machine that warms up.
    WarmUp,
    /// One to three slow waves.
    Sinusoid,
    /// A random walk.
    RandomWalk,
}

const KNOTS: usize = 200;

impl Envelope {
    /// Name of a law with this course.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Ramp => "ramp",
            Self::WarmUp => "warm-up",
            Self::Sinusoid => "slow waves",
            Self::RandomWalk => "random walk",
        }
    }

    /// The course at every clock.
    pub(super) fn course(self, amount: &Amount, clock: impl Iterator<Item = f64>) -> Vec<f64> {
        match self {
            Self::Ramp => clock.map(|c| c - 0.5).collect(),
            Self::WarmUp => {
                let rate = amount.between(0, 3.0, 8.0);
                clock.map(|c| -(-rate * c).exp()).collect()
            }
            Self::Sinusoid => {
                let (waves, phase) = (amount.between(0, 1.0, 3.0), amount.between(1, 0.0, TAU));
                clock.map(|c| 0.5 * (TAU * waves * c + phase).sin()).collect()
            }
            Self::RandomWalk => {
                let walk = random_walk(amount);
                clock.map(|c| interpolate(&walk, c)).collect()
            }
        }
    }
}

/// A walk over the whole dataset; its steps come from the magnitude, so that every passage sees the same one.
fn random_walk(amount: &Amount) -> Vec<f64> {
    let mut rng = ChaCha8Rng::seed_from_u64(amount.shape[3].to_bits());
    let mut level = 0.0;
    (0..=KNOTS)
        .map(|_| {
            let step: f64 = StandardNormal.sample(&mut rng);
            level += step / (KNOTS as f64).sqrt();
            level
        })
        .collect()
}

fn interpolate(walk: &[f64], clock: f64) -> f64 {
    let place = clock * KNOTS as f64;
    let left = (place as usize).min(KNOTS - 1);
    walk[left] + (walk[left + 1] - walk[left]) * (place - left as f64)
}
