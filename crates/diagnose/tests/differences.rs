//! A machine and simulators of it: what differs is found, with its value on both sides, and nothing else.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use switchback_diagnose::differences::{Differences, MachineRecord, Row, Source, compare};
use switchback_model::Record;

/// A spring with play and friction behind a second order of unit gain: the pole of a continuous mode of frequency `omega` (radians a sample) and damping `zeta`.
#[derive(Debug, Clone, Copy)]
struct Machine {
    play: f64,
    friction: f64,
    stiffness: f64,
    omega: f64,
    zeta: f64,
    viscous: f64,
    inertia: f64,
    gain: f64,
    zero: f64,
    late: usize,
}

const SOUND: Machine = Machine {
    play: 1.0,
    friction: 5.0,
    stiffness: 1.0,
    omega: 0.4,
    zeta: 0.6,
    viscous: 0.0,
    inertia: 0.0,
    gain: 1.0,
    zero: 0.0,
    late: 0,
};

impl Machine {
    fn run(&self, v: &[f64]) -> Vec<f64> {
        let radius = (-self.zeta * self.omega).exp();
        let angle = self.omega * (1.0 - self.zeta * self.zeta).sqrt();
        let (a1, a2) = (-2.0 * radius * angle.cos(), radius * radius);
        let (mut p, mut side, mut y) = (v[0], 1.0, Vec::new());
        let mut positions = Vec::new();
        for v in v {
            let q = p.clamp(v - 0.5 * self.play, v + 0.5 * self.play);
            side = if q > p {
                1.0
            } else if q < p {
                -1.0
            } else {
                side
            };
            p = q;
            positions.push((p, side));
        }
        let at = |t: isize| positions[t.clamp(0, positions.len() as isize - 1) as usize].0;
        for (t, (p, side)) in positions.iter().enumerate() {
            let t = t as isize;
            let velocity = 0.5 * (at(t + 1) - at(t - 1));
            let acceleration = at(t + 1) - 2.0 * at(t) + at(t - 1);
            let u = self.stiffness * p
                + side * self.friction
                + self.viscous * velocity
                + self.inertia * acceleration;
            let [before, earlier] = match y[..] {
                [.., earlier, before] => [before, earlier],
                [only] => [only, only],
                _ => [u, u],
            };
            y.push((1.0 + a1 + a2) * u - a1 * before - a2 * earlier);
        }
        (0..y.len()).map(|t| self.gain * y[t.saturating_sub(self.late)] + self.zero).collect()
    }
}

/// A position that goes to random places at random speeds, smoothly.
fn walk(seed: u64, samples: usize) -> Vec<f64> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let (mut v, mut target, mut step, mut speed) = (0.0_f64, 0.0_f64, 0.1_f64, 0.0_f64);
    (0..samples)
        .map(|_| {
            if (target - v).abs() < 1.0 {
                target = 40.0 * rng.random::<f64>() - 20.0;
                step = 0.1 + 0.7 * rng.random::<f64>();
            }
            speed += 0.3 * (step * (target - v).signum() - speed);
            v += speed;
            v
        })
        .collect()
}

fn measured(machine: Machine, v: &[f64], noise: f64, seed: u64) -> Record {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let y = machine.run(v).iter().map(|y| y + noise * rng.sample::<f64, _>(StandardNormal)).collect();
    Record::new(v.to_vec(), y).expect("a record")
}

/// What a comparison of the machine with the simulator finds.
fn beside(machine: Machine, simulator: Machine, seed: u64) -> Differences {
    let v = walk(seed, 4000);
    let record = measured(machine, &v, 0.3, seed + 1000);
    let predicted = simulator.run(&v);
    let machine = [MachineRecord { record: &record, predicted: Some(&predicted), is_fitted: true }];
    compare(&machine, &Source::Predictions).expect("a comparison").expect("a gain at rest")
}

fn off(found: &Differences) -> Vec<&Row> {
    found.rows.iter().filter(|row| row.differs).collect()
}

/// The one row that differs is this one, and the values differ as they should, within four standard errors and half a percent of the value.
fn only(found: &Differences, what: &str, difference: f64) {
    let off = off(found);
    assert_eq!(off.iter().map(|row| row.what.as_str()).collect::<Vec<_>>(), [what], "{off:#?}");
    let row = off[0];
    let error = (row.in_b - row.in_a - difference).abs();
    assert!(error < 4.0 * row.se + 0.005 * row.in_b.abs(), "{row:?} {difference}");
    assert!(row.closure > 0.95, "{row:?}");
}

#[test]
fn a_simulator_that_is_right_differs_in_nothing() {
    for seed in 1..4 {
        let found = beside(SOUND, SOUND, seed);
        assert!(off(&found).is_empty(), "{seed} {:#?}", off(&found));
        let play = found.rows.iter().find(|row| row.what == "play").expect("both have a play");
        assert!((play.in_a - 1.0).abs() < 0.04 && (play.in_b - 1.0).abs() < 0.04, "{play:?}");
    }
}

#[test]
fn a_delay_that_is_off_is_the_one_row() {
    only(&beside(SOUND, Machine { late: 1, ..SOUND }, 11), "delay", -1.0);
    only(&beside(Machine { late: 3, ..SOUND }, SOUND, 12), "delay", 3.0);
}

#[test]
fn a_gain_or_a_zero_that_is_off_is_the_one_row() {
    only(&beside(Machine { gain: 1.05, ..SOUND }, SOUND, 13), "gain", 0.05);
    only(&beside(SOUND, Machine { gain: -1.0, ..SOUND }, 14), "gain", -2.0);
    only(&beside(Machine { zero: 2.0, ..SOUND }, SOUND, 15), "offset", 2.0);
}

#[test]
fn a_border_that_is_off_is_the_one_row() {
    only(&beside(SOUND, Machine { friction: 3.5, ..SOUND }, 16), "friction", 1.5);
    only(&beside(SOUND, Machine { stiffness: 0.9, ..SOUND }, 17), "stiffness", 0.1);
}

#[test]
fn a_frequency_or_a_play_that_is_off_is_the_one_row() {
    only(&beside(SOUND, Machine { omega: 0.3, ..SOUND }, 18), "frequency", 0.1);
    only(&beside(SOUND, Machine { play: 0.6, ..SOUND }, 19), "play", 0.4);
}

#[test]
fn an_effect_that_the_simulator_lacks_is_named_with_its_size() {
    let found = beside(SOUND, Machine { play: 0.0, ..SOUND }, 21);
    only(&found, "play", 1.0);
    let row = off(&found)[0];
    assert_eq!((row.effect, row.in_a), (Some("backlash"), 0.0));
    let damped = Machine { viscous: 5.0, ..SOUND };
    let found = beside(damped, SOUND, 22);
    assert_eq!(off(&found)[0].what, "damping", "{:#?}", off(&found));
    assert!((off(&found)[0].in_b - 5.0).abs() < 0.3, "{:#?}", off(&found));
}

#[test]
fn a_play_of_the_simulators_own_is_found_behind_a_dead_time() {
    let late = Machine { late: 4, zeta: 0.3, ..SOUND };
    only(&beside(Machine { play: 0.6, ..late }, late, 61), "play", -0.4);
    // Between two teeth of the deviance nothing separates a play from the friction of straight borders.
    let found = beside(Machine { play: 0.0, ..late }, late, 62);
    let [row] = off(&found)[..] else { panic!("{:#?}", off(&found)) };
    assert!(row.what == "play" && row.in_b == 0.0 && (row.in_a - 1.0).abs() < 0.02, "{row:?}");
}

/// A simulator begins on its ascending border whatever its first move is, and shows a dead time later that it was another one.
#[test]
fn a_simulator_that_begins_on_the_other_border_keeps_its_order() {
    let mut v = walk(42, 4000);
    let first = v[1] - v[0];
    v.iter_mut().for_each(|v| *v *= -first.signum());
    let simulator = Machine { play: 0.0, late: 4, omega: 0.2, zeta: 0.3, ..SOUND };
    let record = measured(Machine { omega: 0.3, ..simulator }, &v, 0.3, 1042);
    let predicted = simulator.run(&v);
    let machine = [MachineRecord { record: &record, predicted: Some(&predicted), is_fitted: true }];
    let found = compare(&machine, &Source::Predictions).expect("a comparison").expect("a gain at rest");
    assert_eq!(found.source.linear.a().len(), 2);
    only(&found, "frequency", 0.1);
    let row = off(&found)[0];
    assert!((row.in_a / 0.2 - 1.0).abs() < 1e-3, "{row:?}");
}

#[test]
fn several_values_that_are_off_are_all_found() {
    let other = Machine { friction: 4.0, late: 2, zero: 1.0, ..SOUND };
    let found = beside(SOUND, other, 31);
    let mut names: Vec<&str> = off(&found).iter().map(|row| row.what.as_str()).collect();
    names.sort_unstable();
    assert_eq!(names, ["delay", "friction", "offset"], "{:#?}", off(&found));
}

#[test]
fn records_of_another_day_are_compared_without_predictions() {
    let monday = measured(SOUND, &walk(41, 4000), 0.3, 7);
    let tuesday = measured(Machine { zero: 1.7, ..SOUND }, &walk(42, 3000), 0.3, 8);
    let machine = [MachineRecord { record: &tuesday, predicted: None, is_fitted: true }];
    let found = compare(&machine, &Source::Records(vec![monday])).expect("a comparison").expect("a gain");
    only(&found, "offset", 1.7);
}

#[test]
fn the_units_of_either_signal_do_not_matter() {
    let v = walk(51, 3000);
    let record = measured(Machine { friction: 6.0, ..SOUND }, &v, 0.3, 9);
    let predicted = SOUND.run(&v);
    let scaled = |x: &[f64], by: f64| x.iter().map(|x| x * by).collect::<Vec<_>>();
    let found = |by_v: f64, by_y: f64| {
        let record = Record::new(scaled(record.v(), by_v), scaled(record.y(), by_y)).expect("a record");
        let predicted = scaled(&predicted, by_y);
        let machine = [MachineRecord { record: &record, predicted: Some(&predicted), is_fitted: true }];
        compare(&machine, &Source::Predictions).expect("a comparison").expect("a gain at rest")
    };
    let plain = found(1.0, 1.0);
    only(&plain, "friction", 1.0);
    let other = found(1e-3, 1e3);
    let [here, there] = [&plain, &other].map(|found| off(found)[0].clone());
    assert!((there.in_b / 1e3 / here.in_b - 1.0).abs() < 1e-3, "{here:?} {there:?}");
    assert_eq!(off(&other).len(), 1);
}
