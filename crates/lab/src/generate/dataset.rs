//! The dataset: which records are taken, in which order, with which inputs.

use crate::generate::machine::Machine;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use switchback_model::hysteresis::Interval;
use switchback_model::rig::{Role, Usage};

/// How many samples of what a dataset takes.
///
/// The default is a step at each satellite, 120 periods of each pulse experiment and a free sweep to fit, a free
/// drive and 40 periods more of the descendant experiment held out: some 17,000 samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Plan {
    /// Samples of each step experiment.
    pub step: usize,
    /// Periods of each pulse experiment.
    pub periods: usize,
    /// Samples of the free sweep.
    pub sweep: usize,
    /// Samples of the free drive held out.
    pub drive: usize,
    /// Periods of the descendant repeat held out.
    pub repeat_periods: usize,
}

impl Default for Plan {
    fn default() -> Self {
        Self { step: 1500, periods: 120, sweep: 4000, drive: 4000, repeat_periods: 40 }
    }
}

/// One record running: a lead-in that nobody records, then the record.
///
/// The lead-in loads a border and lets the output settle, so that the record starts from a steady state.
#[derive(Debug, Clone, PartialEq)]
pub struct Passage {
    /// Name of the record.
    pub name: String,
    /// What drives the input.
    pub role: Role,
    /// Fit or hold-out.
    pub usage: Usage,
    /// Position in the dataset; the parts of one recording share it, and with it all that is drawn.
    pub index: usize,
    /// Commanded input, lead-in first.
    pub v: Vec<f64>,
    /// Samples of the lead-in.
    pub lead: usize,
    /// Samples between the lead-in and this record: those that an earlier part of the same recording holds.
    pub skipped: usize,
    /// Samples that the dataset has run before this passage.
    pub start: usize,
    /// Samples of the whole dataset.
    pub total: usize,
    /// Travel `Σ|Δv|` of the commanded input before this passage, input units.
    pub travel_before: f64,
    /// Travel of the whole dataset.
    pub total_travel: f64,
}

impl Passage {
    /// A record with its lead-in, not in a dataset yet.
    pub(crate) fn of(
        index: usize,
        name: String,
        (role, usage): (Role, Usage),
        (mut v, record): (Vec<f64>, Vec<f64>),
    ) -> Self {
        let lead = v.len();
        v.extend(record);
        Self {
            name,
            role,
            usage,
            index,
            v,
            lead,
            skipped: 0,
            start: 0,
            total: 0,
            travel_before: 0.0,
            total_travel: 0.0,
        }
    }

    /// The record in two parts, the first `samples` of it and the rest, which is held out. Both belong to one recording: time, travel and
    /// noise run on.
    pub(crate) fn parted(self, samples: usize) -> [Self; 2] {
        let mut first = self.clone();
        first.v.truncate(self.lead + samples);
        let name = format!("{}-held-out", self.name);
        [first, Self { name, usage: Usage::Holdout, skipped: samples, ..self }]
    }

    /// Share of the dataset's time that has passed at sample `t` of the passage, in `[0, 1)`.
    pub(crate) fn clock(&self, t: usize) -> f64 {
        (self.start + t) as f64 / self.total as f64
    }

    /// Share of the dataset's travel that lies behind, sample by sample, in `[0, 1]`.
    pub(crate) fn wear_clock(&self) -> Vec<f64> {
        let mut travel = self.travel_before;
        let mut last = self.v[0];
        self.v
            .iter()
            .map(|&v| {
                travel += (v - last).abs();
                last = v;
                travel / self.total_travel
            })
            .collect()
    }

    /// The part of a signal that is recorded.
    pub(crate) fn recorded<'s>(&self, signal: &'s [f64]) -> &'s [f64] {
        &signal[self.lead + self.skipped..]
    }
}

/// Draws the inputs of a dataset on the machine's levels.
pub(crate) fn dataset(plan: &Plan, machine: &Machine, rng: &mut ChaCha8Rng) -> Vec<Passage> {
    let interval = machine.interval;
    let (low, high) = (interval.low(), interval.high());
    let settle = machine.settling();
    let step = |from: f64, to: f64| std::iter::once(from).chain(std::iter::repeat_n(to, plan.step)).collect();
    let free = |samples: usize, rng: &mut ChaCha8Rng| random_ramps(interval, samples, rng);
    let recorded: Vec<(&'static str, Role, Usage, Vec<f64>)> = vec![
        ("step_high", Role::StepHigh, Usage::Fit, step(low, high)),
        ("descendant", Role::Descendant, Usage::Fit, descendant(machine, plan.periods)),
        ("step_low", Role::StepLow, Usage::Fit, step(high, low)),
        ("ascendant", Role::Ascendant, Usage::Fit, ascendant(machine, plan.periods)),
        ("sweep", Role::Free, Usage::Fit, free(plan.sweep, rng)),
        ("drive", Role::Free, Usage::Holdout, free(plan.drive, rng)),
        ("descendant_again", Role::Descendant, Usage::Holdout, descendant(machine, plan.repeat_periods)),
    ];
    let passages = recorded.into_iter().enumerate().map(|(index, (name, role, usage, record))| {
        let lead = lead_in(interval, record[0], settle);
        Passage::of(index, name.to_owned(), (role, usage), (lead, record))
    });
    one_after_the_other(passages.collect())
}

/// The passages of one dataset, clocks and travel running on.
pub(crate) fn one_after_the_other(mut passages: Vec<Passage>) -> Vec<Passage> {
    let (mut start, mut travel) = (0, 0.0);
    for passage in &mut passages {
        (passage.start, passage.travel_before) = (start, travel);
        start += passage.v.len();
        travel += passage.v.windows(2).map(|w| (w[1] - w[0]).abs()).sum::<f64>();
    }
    for passage in &mut passages {
        (passage.total, passage.total_travel) = (start, travel);
    }
    passages
}

/// Loads the border that ends at `start`, and lets the output settle there.
pub(crate) fn lead_in(interval: Interval, start: f64, settle: usize) -> Vec<f64> {
    let (low, high) = (interval.low(), interval.high());
    let (near, far) = if start > low { (high, low) } else { (low, high) };
    let mut v = vec![near, far];
    v.extend(std::iter::repeat_n(far, settle));
    v.extend((1..20).map(|k| far + (start - far) * f64::from(k) / 20.0));
    v.extend(std::iter::repeat_n(start, settle));
    v
}

/// The descendant experiment (3.1) after one loading move.
fn descendant(machine: &Machine, periods: usize) -> Vec<f64> {
    let m = machine.levels.len() - 1;
    pulses(machine, periods, machine.interval.low(), machine.interval.high(), &machine.levels[..m])
}

/// The ascendant experiment (4.1) after one loading move.
fn ascendant(machine: &Machine, periods: usize) -> Vec<f64> {
    let visited: Vec<f64> = machine.levels[1..].iter().rev().copied().collect();
    pulses(machine, periods, machine.interval.high(), machine.interval.low(), &visited)
}

/// From the satellite, visits of one sample: the first at `2s`, the j-th (j ≥ 2) at `(2+j)s`, period `s(m+3)`.
fn pulses(machine: &Machine, periods: usize, load: f64, satellite: f64, visited: &[f64]) -> Vec<f64> {
    let s = machine.order().max(2);
    let mut period = vec![satellite; s * (visited.len() + 3)];
    for (j, &level) in visited.iter().enumerate() {
        period[if j == 0 { 2 * s } else { (3 + j) * s }] = level;
    }
    let mut v = vec![load];
    for _ in 0..periods {
        v.extend_from_slice(&period);
    }
    v
}

/// Ramps between random levels, of random duration, with rests in between; strictly inside the interval.
fn random_ramps(interval: Interval, samples: usize, rng: &mut ChaCha8Rng) -> Vec<f64> {
    let within = |z: f64| interval.low() + interval.width() * z;
    let mut z = rng.random_range(0.3..0.7);
    let mut v = vec![within(z)];
    while v.len() < samples {
        let target = loop {
            let target: f64 = if rng.random_bool(0.4) {
                // A short stroke: nested loops show what full strokes hide.
                (z + rng.random_range(-0.25..0.25_f64)).clamp(0.01, 0.99)
            } else {
                rng.random_range(0.01..0.99)
            };
            if (target - z).abs() > 0.04 {
                break target;
            }
        };
        let duration = (rng.random_range(1.0..5.5_f64)).exp2().round() as usize;
        // The last sample is the target itself, to the bit: a rest must not move.
        v.extend((1..duration).map(|k| within(z + (target - z) * k as f64 / duration as f64)));
        v.push(within(target));
        if rng.random_bool(0.5) {
            v.extend(std::iter::repeat_n(within(target), rng.random_range(1..8)));
        }
        z = target;
    }
    v.truncate(samples);
    v
}
