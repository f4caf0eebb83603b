//! The nominal system of a machine of the field: sampled at a rate that nobody chose with its poles in mind.

use crate::generate::machine::{CURVED, Family, Machine, multiply};
use crate::generate::stream::{Purpose, stream};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

/// What borders that are curved between any levels are called, if a cause of a gap.
pub(super) const CURVED_BORDERS: &str = "border_resolution";

/// Draws the system; the slowest time constant is given in samples.
pub(super) fn draw((seed, family): (u64, Family), time_constant: f64, spared: &[&str]) -> Machine {
    let often_curved = if spared.contains(&CURVED_BORDERS) { 0.0 } else { CURVED };
    let poles = |order: usize, rng: &mut ChaCha8Rng| denominator(order, time_constant, rng);
    Machine::draw_with(family, (poles, often_curved), &mut stream(seed, Purpose::Machine))
}

/// A denominator whose slowest pole, or pair of damping 0.3 to 0.95, decays with the time constant, all others with 0.15 to 0.6 of it.
fn denominator(order: usize, time_constant: f64, rng: &mut ChaCha8Rng) -> Vec<f64> {
    let slowest = pole(time_constant);
    let is_pair = order >= 2 && rng.random_bool(0.5);
    let mut polynomial = if is_pair {
        // ζ = 1/√(1 + (ωT)²)
        let angle = rng.random_range(0.33..3.2_f64) / time_constant;
        vec![1.0, -2.0 * slowest * angle.cos(), slowest * slowest]
    } else {
        vec![1.0, -slowest]
    };
    while polynomial.len() <= order {
        polynomial = multiply(&polynomial, &[1.0, -pole(time_constant * rng.random_range(0.15..0.6))]);
    }
    polynomial.split_off(1)
}

/// The pole of a time constant in samples.
pub(super) fn pole(time_constant: f64) -> f64 {
    (-1.0 / time_constant).exp()
}

/// Labels of input and output, as owners of rigs write them.
pub(super) fn labels(rng: &mut ChaCha8Rng) -> (String, String) {
    const LABELS: [(&str, &str); 8] = [
        ("displacement [mm]", "force [N]"),
        ("voltage [V]", "displacement [um]"),
        ("current [A]", "torque [N m]"),
        ("pump voltage [V]", "level [cm]"),
        ("valve opening [%]", "flow [l/min]"),
        ("angle [deg]", "torque [N m]"),
        ("field [A/m]", "flux density [mT]"),
        ("command", "speed"),
    ];
    let (input, output) = LABELS[rng.random_range(0..LABELS.len())];
    (input.to_owned(), output.to_owned())
}

/// Seconds between samples: 1, 2 or 5 times a power of ten, from 0.1 ms to 50 s.
pub(super) fn sample_time(rng: &mut ChaCha8Rng) -> f64 {
    const STEPS: [&str; 3] = ["1", "2", "5"];
    let decade = rng.random_range(-4..=1);
    // Read as a decimal, so that it is the number that a user would write.
    format!("{}e{decade}", STEPS[rng.random_range(0..STEPS.len())]).parse().expect("a decimal number")
}

/// The noise that an owner sees in the output: 0.1 % to 2 % of the stationary span.
pub(super) fn output_noise(rng: &mut ChaCha8Rng) -> f64 {
    10.0_f64.powf(rng.random_range(-3.0..-1.7))
}
