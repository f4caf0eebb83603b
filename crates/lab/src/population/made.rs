//! Setups of made machines: of the laboratory, of the field, and of wide draws.

use super::borders::Curves;
use super::drive::WideDrive;
use super::family::Family;
use super::model_error;
use super::noise::{ManyColours, RoundedInput};
use super::parts::{Mode, Parts};
use super::random::{log_uniform, one_of, weighted};
use super::setup::{OWN_SLOTS, Run, Setup, spread};
use crate::generate::dataset::{dataset, lead_in, one_after_the_other};
use crate::generate::field;
use crate::generate::field::reading::Reading;
use crate::generate::law::{Amount, Law};
use crate::generate::machine::{self, Machine};
use crate::generate::simulate::{Active, Noise, simulate};
use crate::generate::stream::{Purpose, stream};
use crate::generate::{Passage, Plan};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use switchback_model::hysteresis::Interval;
use switchback_model::rig::{Role, Usage};

const NO_FAMILY: machine::Family = machine::Family { order: None, shape: None };

/// A machine of the laboratory with a plan smaller than an examination's; every other time without its last record.
pub(super) fn laboratory(seed: u64) -> Setup {
    let mut rng = stream(seed, Purpose::Base);
    let machine = Machine::draw(NO_FAMILY, &mut stream(seed, Purpose::Machine));
    let period = machine.order().max(2) * (machine.levels.len() + 2);
    let pulses = log_uniform(&mut rng, 300.0, 2500.0) as usize;
    let free = |rng: &mut ChaCha8Rng| log_uniform(rng, 400.0, 3500.0) as usize;
    let plan = Plan {
        step: log_uniform(&mut rng, 60.0, 800.0) as usize,
        periods: (pulses / period).max(4),
        sweep: free(&mut rng),
        drive: free(&mut rng),
        repeat_periods: (pulses / period / 3).max(2),
    };
    let mut passages = dataset(&plan, &machine, &mut stream(seed, Purpose::Drive));
    if rng.random_bool(0.5) {
        passages.pop();
        passages = one_after_the_other(passages);
    }
    let (order, interval) = (machine.order(), machine.interval);
    let mut setup = Setup {
        family: Family::Laboratory,
        base: Family::Laboratory.name().to_owned(),
        borders: machine.shape.name(),
        machine,
        own: Vec::new(),
        runs: passages.into_iter().map(run).collect(),
        seed,
        order,
        declared: Some((order, interval)),
        labels: ("v".to_owned(), "y".to_owned()),
        noise: 0.0,
    };
    finish(&mut setup);
    setup.noise = setup.machine.noise_sd * setup.machine.noise_amplification() / spread(&setup.runs);
    setup
}

/// A machine of the field, spared of what is to be put in.
pub(super) fn field(seed: u64, spared: &[&str]) -> Setup {
    let generator = field::generator(seed, NO_FAMILY, spared);
    let own = generator.base().to_vec();
    let machine = generator.machine;
    let mut setup = Setup {
        family: Family::Field,
        base: Family::Field.name().to_owned(),
        order: machine.order(),
        borders: machine.shape.name(),
        machine,
        own,
        runs: generator.passages.into_iter().map(run).collect(),
        seed,
        declared: None,
        labels: ("displacement [mm]".to_owned(), "force [N]".to_owned()),
        noise: 0.0,
    };
    finish(&mut setup);
    setup.noise = setup.machine.noise_sd * setup.machine.noise_amplification() / spread(&setup.runs);
    setup
}

/// Noise as a share of the output's standard deviation.
const NOISE: (f64, f64) = (0.002, 0.06);

/// A machine of wide draws, its loudest noise `quieter` times smaller; none where they give none that is normal.
pub(super) fn wide(seed: u64, spared: &[&str], quieter: f64) -> Option<Setup> {
    let mut rng = stream(seed, Purpose::Base);
    let mut setup = of_parts(&parts(&mut rng), seed, &mut rng)?;
    let loudest = (quieter * NOISE.1).max(1.2 * NOISE.0);
    add_noise(&mut setup, log_uniform(&mut rng, NOISE.0, loudest), &mut rng);
    model_error::add(&mut setup, spared, &mut rng)?;
    Some(setup)
}

/// A machine of wide draws with noise and without errors.
pub(super) fn without_errors(parts: &Parts, seed: u64, rng: &mut ChaCha8Rng) -> Option<Setup> {
    let mut setup = of_parts(parts, seed, rng)?;
    add_noise(&mut setup, log_uniform(rng, NOISE.0, NOISE.1), rng);
    Some(setup)
}

/// Another machine on the same inputs, with the same noise anew.
pub(super) fn like(setup: &Setup, parts: &Parts, seed: u64) -> Option<Setup> {
    let machine = Machine { noise_sd: setup.machine.noise_sd, ..parts.machine()? };
    let same =
        |t: &Run| Run { passage: t.passage.clone(), v: t.v.clone(), measured: None, nominal: Vec::new() };
    let mut other = Setup {
        machine,
        order: parts.order(),
        base: setup.base.clone(),
        labels: setup.labels.clone(),
        own: setup.own.clone(),
        runs: setup.runs.iter().map(same).collect(),
        seed,
        ..*setup
    };
    finish(&mut other);
    Some(other)
}

/// Makes a machine's noise so many times louder.
pub(super) fn louder(setup: &mut Setup, factor: f64) {
    setup.machine.noise_sd *= factor;
    setup.noise *= factor;
    for own in setup.own.iter_mut().filter(|own| own.law.name() == ManyColours.name()) {
        own.amount.magnitude *= factor;
    }
}

fn of_parts(parts: &Parts, seed: u64, rng: &mut ChaCha8Rng) -> Option<Setup> {
    let feedthrough = rng.random_bool(0.3);
    let machine = parts.machine()?;
    let runs = runs(&machine, parts.slowest(), feedthrough, &mut stream(seed, Purpose::Drive));
    let mut setup = Setup {
        family: Family::Wide,
        base: Family::Wide.name().to_owned(),
        order: parts.order(),
        borders: parts.curves.kind.name(),
        machine,
        own: Vec::new(),
        runs,
        seed,
        declared: None,
        labels: ("position [mm]".to_owned(), "force [N]".to_owned()),
        noise: 0.0,
    };
    finish(&mut setup);
    Some(setup)
}

/// A machine in physical terms: order 1 to 4, time constants up to 45 samples, borders of ten kinds.
pub(super) fn parts(rng: &mut ChaCha8Rng) -> Parts {
    let slowest = if rng.random_bool(0.15) { 0.05 } else { log_uniform(rng, 0.4, 45.0) };
    let order = 1 + weighted(rng, &[0.3, 0.4, 0.2, 0.1]);
    let mut modes = vec![Mode::Lag { time_constant: slowest }];
    if order >= 2 && slowest > 0.8 && rng.random_bool(0.45) {
        let damping = rng.random_range(0.15..0.95);
        modes = vec![Mode::Oscillation { frequency: (1.0 / (slowest * damping)).min(2.5), damping }];
    }
    let is_pair = matches!(modes[0], Mode::Oscillation { .. });
    while modes.len() + usize::from(is_pair) < order {
        modes.push(Mode::Lag { time_constant: (slowest * rng.random_range(0.1..0.7)).max(0.05) });
    }
    let low = rng.random_range(-2.0..1.0) * 10.0_f64.powi(rng.random_range(-1..=1));
    let width = log_uniform(rng, 0.05, 50.0);
    Parts {
        numerator: numerator(order, rng),
        modes,
        gain: log_uniform(rng, 0.1, 200.0) * if rng.random_bool(0.8) { 1.0 } else { -1.0 },
        offset: if rng.random_bool(0.5) { 0.0 } else { rng.random_range(-20.0..20.0) },
        curves: Curves::draw(rng),
        interval: Interval::new(low, low + width).expect("a width above zero"),
        cells: rng.random_range(7..=12),
        sample_time: one_of(rng, &[1e-4, 1e-3, 0.01, 0.05, 0.5, 2.0]),
    }
}

/// Clear of cancelling; every third time the first lags are missing, which is a delay.
fn numerator(order: usize, rng: &mut ChaCha8Rng) -> Vec<f64> {
    let delay = if rng.random_bool(0.3) { rng.random_range(1..4) } else { 0 };
    loop {
        let b: Vec<f64> = (0..order).map(|_| rng.random_range(-0.4..1.0_f64)).collect();
        let (sum, size) = (b.iter().sum::<f64>(), b.iter().map(|x| x.abs()).sum::<f64>());
        if sum > 0.4 * size && b[0].abs() > 0.2 * size {
            return [vec![0.0; delay], b].concat();
        }
    }
}

/// Samples of a whole dataset, records of it, and their bounds.
const RECORDS: [usize; 5] = [1, 2, 3, 4, 6];
const OFTEN: [f64; 5] = [0.24, 0.32, 0.2, 0.18, 0.06];
const SAMPLES: (f64, f64) = (300.0, 3500.0);

fn runs(machine: &Machine, slowest: f64, feedthrough: bool, rng: &mut ChaCha8Rng) -> Vec<Run> {
    let count = RECORDS[weighted(rng, &OFTEN)];
    let is_long = rng.random_bool(0.02);
    let total = if is_long { log_uniform(rng, 8000.0, 20_000.0) } else { log_uniform(rng, 900.0, 5000.0) };
    let most = if is_long { 20_000.0 } else { SAMPLES.1 };
    let longest = if rng.random_bool(0.6) { 60.0 } else { 400.0 };
    let period = log_uniform(rng, (2.0 * slowest).max(12.0), (25.0 * slowest).max(longest)).min(500.0);
    let held_out = if count > 1 { rng.random_range(1..count) } else { count };
    let run_in = ((5.0 * slowest) as usize + 20).min(250);
    let record = |index: usize| {
        let samples = (total / count as f64 * rng.random_range(0.6..1.5)).clamp(SAMPLES.0, most) as usize;
        let period = (period * log_uniform(rng, 0.5, 2.0)).clamp(10.0, samples as f64 / 4.0);
        let drive = one_of(rng, &WideDrive::ALL);
        let reach = if index == 0 { 1.0 } else { rng.random_range(0.5..1.0) };
        let low = rng.random_range(0.0..=1.0 - reach);
        let place =
            |z: f64| machine.interval.low() + machine.interval.width() * (0.01 + 0.98 * (low + reach * z));
        let mut before: Vec<f64> =
            drive.samples(run_in + samples, period, rng).into_iter().map(place).collect();
        let recorded = before.split_off(run_in);
        let mut lead = lead_in(machine.interval, before[0], 0);
        lead.extend(before);
        let usage = if index == held_out { Usage::Holdout } else { Usage::Fit };
        Passage::of(index, format!("{}-{}", drive.name(), index + 1), (Role::Free, usage), (lead, recorded))
    };
    let mut passages = one_after_the_other((0..count).map(record).collect());
    if count == 1 {
        let single = passages.remove(0);
        let kept = (0.7 * (single.v.len() - single.lead) as f64).round() as usize;
        passages = single.parted(kept).into();
    }
    let led = |passage| if feedthrough { ahead(passage) } else { run(passage) };
    passages.into_iter().map(led).collect()
}

fn run(passage: Passage) -> Run {
    let v = passage.recorded(&passage.v).to_vec();
    Run { passage, v, measured: None, nominal: Vec::new() }
}

/// A record whose output answers within the sample: the machine is given the next input.
fn ahead(mut passage: Passage) -> Run {
    let v = passage.recorded(&passage.v).to_vec();
    passage.v.remove(0);
    passage.v.push(passage.v[passage.v.len() - 1]);
    Run { passage, v, measured: None, nominal: Vec::new() }
}

/// Simulates what the nominal system would do, and learns what the output reaches.
pub(super) fn finish(setup: &mut Setup) {
    let Setup { machine, runs, seed, .. } = setup;
    for run in &mut *runs {
        let y = simulate(machine, &[], &run.passage, *seed, Noise::None).y;
        run.nominal = run.passage.recorded(&y).to_vec();
    }
    let centre = machine.y_centre();
    machine.reach =
        runs.iter().flat_map(|t| &t.nominal).fold(0.0, |most, y| f64::max(most, (y - centre).abs()));
}

/// Gives a machine of wide draws its noise, a share of the output's standard deviation: part in the equation, part in the output, and what the
/// recorder of the input does.
fn add_noise(setup: &mut Setup, noise: f64, rng: &mut ChaCha8Rng) {
    let sd = noise * spread(&setup.runs);
    let part = rng.random_range(0.1..1.0_f64);
    setup.machine.noise_sd = part * sd / setup.machine.noise_amplification();
    setup.noise = noise;
    own(setup, &ManyColours, sd * (1.0 - part * part).sqrt(), rng);
    if rng.random_bool(0.4) {
        own(setup, &Reading, log_uniform(rng, 1e-4, 3e-3), rng);
    }
    if rng.random_bool(0.25) {
        own(setup, &RoundedInput, log_uniform(rng, 1e-5, 3e-3), rng);
    }
}

/// Adds what a machine has by itself.
pub(super) fn own(setup: &mut Setup, law: &'static dyn Law, magnitude: f64, rng: &mut ChaCha8Rng) {
    let amount = Amount { magnitude, shape: std::array::from_fn(|_| rng.random()) };
    setup.own.push(Active { law, amount, slot: OWN_SLOTS + setup.own.len() });
}
