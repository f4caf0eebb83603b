//! `creep`: the operator's output drifts on by itself.

use super::card;
use super::motion::{directions, moves, since_reversal};
use crate::generate::law::{Law, Scene};

pub(super) static LAWS: [&dyn Law; 3] = [&Logarithmic, &KelvinVoigt, &RestingCreep];

/// Logarithmic in time since the reversal, as of piezoceramics: `u' = u + x·s·log₁₀(1 + τ/τ₀)`, τ₀ 1 to 8 samples.
#[derive(Debug)]
struct Logarithmic;

impl Law for Logarithmic {
    card!("creep", "logarithmic", Operator, "spans of u a decade", 1.0);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let start = scene.amount.between(0, 1.0, 8.0);
        let directions = directions(scene.machine, v);
        for (t, since) in since_reversal(&directions).into_iter().enumerate() {
            u[t] += scene.x() * directions[t] * (1.0 + since / start).log10();
        }
    }
}

/// Three Kelvin–Voigt elements in series: `u' = u + x·mean_k(ℓ_k − u)`, `ℓ_k` lagging by 10, 50, 250 samples.
#[derive(Debug)]
struct KelvinVoigt;

impl Law for KelvinVoigt {
    card!("creep", "sum of exponentials", Operator, "share of u that creeps", 0.9);

    fn operator(&self, scene: &mut Scene<'_>, _v: &[f64], u: &mut [f64]) {
        let mut lags = [u[0]; 3];
        for now in u {
            let instant = *now;
            for (lag, samples) in lags.iter_mut().zip([10.0, 50.0, 250.0_f64]) {
                *lag += (instant - *lag) / samples;
                *now += scene.amount.magnitude * (*lag - instant) / 3.0;
            }
        }
    }
}

/// Creep that runs at rest only and is wiped out by the next move: `u' = u + x·s·(1 − e^{−τ/τ₀})`.
#[derive(Debug)]
struct RestingCreep;

impl Law for RestingCreep {
    card!("creep", "resting", Operator, "spans of u", 1.0);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let time = scene.amount.between(0, 2.0, 30.0);
        let directions = directions(scene.machine, v);
        let mut rest = 0.0;
        for (t, speed) in moves(scene.machine, v).into_iter().enumerate() {
            rest = if speed == 0.0 { rest + 1.0 } else { 0.0 };
            u[t] += scene.x() * directions[t] * (1.0 - (-rest / time).exp());
        }
    }
}
