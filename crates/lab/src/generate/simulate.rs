//! One passage through the block diagram.

use crate::generate::dataset::Passage;
use crate::generate::law::{Amount, Law, Nature, Scene};
use crate::generate::machine::Machine;
use crate::generate::stream::{Purpose, stream};
use rand_distr::{Distribution, StandardNormal};

/// An effect that acts in a rig.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Active {
    /// Its law.
    pub law: &'static dyn Law,
    /// How much of it.
    pub amount: Amount,
    /// Its position among the rig's effects: names its random stream.
    pub slot: usize,
}

/// What noise a simulation has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Noise {
    /// All of it, as recorded.
    Recorded,
    /// None: the output that would repeat, noise effects left out.
    None,
}

/// The signals of one passage, lead-in included.
#[derive(Debug, Clone)]
pub(crate) struct Trace {
    /// Recorded output.
    pub y: Vec<f64>,
    /// The white equation error before any effect acted on it.
    pub white: Vec<f64>,
}

/// Runs one passage: input, operator, dynamics, disturbance, sensor, each with its effects in order.
pub(crate) fn simulate(
    machine: &Machine,
    active: &[Active],
    passage: &Passage,
    seed: u64,
    noise: Noise,
) -> Trace {
    let mut effects: Vec<(&dyn Law, Scene<'_>)> = active
        .iter()
        .filter(|e| noise == Noise::Recorded || e.law.nature() == Nature::Systematic)
        .map(|e| {
            let rng = stream(seed, Purpose::Effect { effect: e.slot, record: passage.index });
            (e.law, Scene { machine, passage, amount: e.amount, rng })
        })
        .collect();
    let mut v = passage.v.clone();
    effects.iter_mut().for_each(|(law, scene)| law.drive(scene, &mut v));
    let before =
        if v[0] > machine.interval.low() { machine.hysteresis.u_high() } else { machine.hysteresis.u_low() };
    let mut u = machine.hysteresis.output(&v, before);
    effects.iter_mut().for_each(|(law, scene)| law.operator(scene, &v, &mut u));
    effects.iter_mut().for_each(|(law, scene)| law.dynamics(scene, &mut u));
    let white = match noise {
        Noise::Recorded => white_noise(machine, passage, seed),
        Noise::None => vec![0.0; v.len()],
    };
    let mut xi = white.clone();
    effects.iter_mut().for_each(|(law, scene)| law.equation_error(scene, &u, &mut xi));
    let mut y = difference_equation(machine, &effects, &u, &xi, before);
    effects.iter_mut().for_each(|(law, scene)| law.sensor(scene, &mut y));
    Trace { y, white }
}

fn white_noise(machine: &Machine, passage: &Passage, seed: u64) -> Vec<f64> {
    let mut rng = stream(seed, Purpose::Noise(passage.index));
    let normals = StandardNormal.sample_iter(&mut rng);
    normals.take(passage.v.len()).map(|w: f64| machine.noise_sd * w).collect()
}

/// `y(t) = −Σ aᵢ y(t−i) + Σ bᵢ u(t−i) + ξ(t) + feedback(y(t−1))`, from the steady state that `before` holds.
fn difference_equation(
    machine: &Machine,
    effects: &[(&dyn Law, Scene<'_>)],
    u: &[f64],
    xi: &[f64],
    before: f64,
) -> Vec<f64> {
    let y_before = machine.gain() * before;
    let mut y: Vec<f64> = Vec::with_capacity(u.len());
    for t in 0..u.len() {
        let past = |signal: &[f64], i: usize, rest: f64| if t > i { signal[t - 1 - i] } else { rest };
        let mut now = xi[t];
        for i in 0..machine.order() {
            now += machine.b[i] * past(u, i, before) - machine.a[i] * past(&y, i, y_before);
        }
        let last = past(&y, 0, y_before);
        for (law, scene) in effects {
            now += law.feedback(scene, last);
        }
        y.push(now);
    }
    y
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::dataset::{Plan, dataset};
    use crate::generate::effects::{EFFECTS, FOREIGN, laws_of};
    use crate::generate::machine::Family;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        #[test]
        fn with_magnitude_zero_every_law_gives_the_nominal_output_to_the_bit(seed in any::<u64>(), shape: [f64; 4]) {
            let shape = shape.map(|x| (x.abs().fract() + 0.5).fract());
            let machine = Machine::draw(Family { order: None, shape: None }, &mut stream(seed, Purpose::Machine));
            let plan = Plan { step: 40, periods: 2, sweep: 150, drive: 60, repeat_periods: 1 };
            let passages = dataset(&plan, &machine, &mut stream(seed, Purpose::Drive));
            for passage in &passages {
                let nominal = simulate(&machine, &[], passage, seed, Noise::Recorded);
                for law in EFFECTS.iter().chain(&FOREIGN).flat_map(|e| laws_of(e)) {
                    let active = Active { law: *law, amount: Amount { magnitude: 0.0, shape }, slot: 0 };
                    let with = simulate(&machine, &[active], passage, seed, Noise::Recorded);
                    prop_assert_eq!(&with.y, &nominal.y, "{} {}", law.effect(), law.name());
                }
            }
        }
    }
}
