//! What a machine of the field has beside its nominal system.

use super::colour::{self, Colour};
use super::machine::pole;
use super::reading::Reading;
use crate::generate::effects::laws_of;
use crate::generate::law::{Amount, Law};
use crate::generate::machine::{Machine, amplification, multiply};
use crate::generate::simulate::Active;
use crate::generate::stream::{Purpose, stream};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use std::ops::Range;

/// Slots of properties begin here: far beyond those of effects, so that their random streams never meet.
const FIRST_SLOT: usize = 1 << 12;

/// How often a machine has what not all have.
const WITH_READING_NOISE: f64 = 0.6;
const WITH_SOFT_BORDERS: f64 = 0.4;
const WITH_FAST_POLE: f64 = 0.3;

/// Correlation time of the equation noise, and the time constant of the fast pole, over the slowest time constant.
const COLOUR: Range<f64> = 0.05..1.0;
const FAST: Range<f64> = 0.06..0.2;
/// Noise on the recorded input, and the travel along which soft borders switch, in interval widths; drawn evenly over the logarithm. Dahl's
/// law is through after 2√2 lengths: the shortest is longer than what the fastest triangle, 2/24 widths a sample, could hide.
const READING_NOISE: Range<f64> = 1e-4..3e-3;
const TRANSITION: Range<f64> = 0.03..0.1;

/// Draws all properties and leaves out those of the given names: the others stay what they were.
pub(super) fn draw(seed: u64, time_constant: f64, spared: &[&str], rng: &mut ChaCha8Rng) -> Vec<Active> {
    let soft = laws_of("gradual_transition");
    let all: [(&'static dyn Law, f64, f64); 4] = [
        (&Colour, 1.0, pole(time_constant * rng.random_range(COLOUR))),
        (&Reading, WITH_READING_NOISE, evenly_over_the_logarithm(READING_NOISE, rng)),
        (
            soft[rng.random_range(0..soft.len())],
            WITH_SOFT_BORDERS,
            evenly_over_the_logarithm(TRANSITION, rng),
        ),
        (laws_of("extra_pole")[0], WITH_FAST_POLE, pole(time_constant * rng.random_range(FAST))),
    ];
    let mut base = Vec::new();
    for (slot, (law, often, magnitude)) in (FIRST_SLOT..).zip(all) {
        if rng.random_bool(often) && !spared.contains(&law.effect()) {
            let mut shapes = stream(seed, Purpose::Shape(slot));
            let amount = Amount { magnitude, shape: std::array::from_fn(|_| shapes.random()) };
            base.push(Active { law, amount, slot });
        }
    }
    base
}

fn evenly_over_the_logarithm(range: Range<f64>, rng: &mut ChaCha8Rng) -> f64 {
    rng.random_range(range.start.ln()..range.end.ln()).exp()
}

/// Output noise sd over that of the equation noise's innovations, with the colour that the base gives it.
pub(super) fn noise_amplification(machine: &Machine, base: &[Active]) -> f64 {
    let mut denominator = [&[1.0], machine.a.as_slice()].concat();
    if let Some(colour) = base.iter().find(|property| property.law.effect() == Colour.effect()) {
        denominator = multiply(&denominator, &colour::denominator(&colour.amount));
    }
    amplification(&denominator[1..])
}
