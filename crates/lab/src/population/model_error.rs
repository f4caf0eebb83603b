//! What a machine has besides that no simple model has: up to three small effects, known or foreign.

use super::random::{log_uniform, one_of, weighted};
use super::setup::{OWN_SLOTS, Setup, spread};
use crate::generate::effects::{FOREIGN, FURTHER_FOREIGN, laws_of};
use crate::generate::law::{Amount, Law, Nature};
use crate::generate::simulate::{Active, Noise, simulate};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

/// Known effects of which a little is in most machines.
const COMMON: [&str; 8] = [
    "gradual_transition",
    "extra_pole",
    "rate_dependence",
    "creep",
    "sensor_nonlinearity",
    "border_resolution",
    "resonance",
    "stribeck",
];

/// How many there are.
const COUNTS: [f64; 4] = [0.25, 0.3, 0.25, 0.2];
/// In two machines of three they are smaller than the noise, in the others up to six times larger.
const SMALL: f64 = 0.65;

/// Adds them, sized in standard deviations of the noise; none where a signal is not finite.
pub(super) fn add(setup: &mut Setup, spared: &[&str], rng: &mut ChaCha8Rng) -> Option<()> {
    let count = weighted(rng, &COUNTS);
    let size = if rng.random_bool(SMALL) { log_uniform(rng, 0.15, 1.0) } else { log_uniform(rng, 1.0, 6.0) };
    let noise = setup.noise * spread(&setup.runs);
    for _ in 0..count {
        let (effect, is_foreign) = draw(rng);
        let law = one_of(rng, laws_of(effect));
        if spared.contains(&effect) || law.nature() == Nature::Noise {
            continue;
        }
        // Of known effects only little: more would be a cause.
        let wanted = noise * if is_foreign { size } else { size.min(0.6) } / (count as f64).sqrt();
        let shape = std::array::from_fn(|_| rng.random());
        let slot = OWN_SLOTS + setup.own.len();
        let magnitude = magnitude(setup, (law, shape, slot), wanted)?;
        setup.own.push(Active { law, amount: Amount { magnitude, shape }, slot });
    }
    Some(())
}

fn draw(rng: &mut ChaCha8Rng) -> (&'static str, bool) {
    match rng.random_range(0..3) {
        0 => (one_of(rng, &COMMON), false),
        1 => (one_of(rng, &FOREIGN), true),
        _ => (one_of(rng, &FURTHER_FOREIGN), true),
    }
}

/// The magnitude at which the output changes by a root mean square, in three secant steps.
pub(super) fn magnitude(
    setup: &Setup,
    (law, shape, slot): (&'static dyn Law, [f64; 4], usize),
    wanted: f64,
) -> Option<f64> {
    let mut magnitude = 0.05 * law.limit();
    for _ in 0..3 {
        let active = Active { law, amount: Amount { magnitude, shape }, slot };
        let (mut sum, mut count) = (0.0, 0.0);
        for run in &setup.runs {
            let y = simulate(&setup.machine, &[active], &run.passage, setup.seed, Noise::None).y;
            for (with, without) in run.passage.recorded(&y).iter().zip(&run.nominal) {
                sum += (with - without).powi(2);
                count += 1.0;
            }
        }
        let reached = (sum / f64::max(count, 1.0)).sqrt();
        if !reached.is_finite() {
            return None;
        }
        magnitude = (magnitude * (wanted / reached.max(1e-300)).clamp(0.02, 30.0)).min(0.9 * law.limit());
    }
    Some(magnitude)
}
