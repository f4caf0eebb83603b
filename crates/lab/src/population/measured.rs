//! Setups around measured records.

use super::borders::{PLACES, smooth};
use super::family::Family;
use super::made;
use super::random::{log_uniform, one_of};
use super::setup::{Run, Setup, spread};
use crate::examination::field::{resampled, runs_of};
use crate::examination::scramble;
use crate::generate::Passage;
use crate::generate::injection::host_model::passages;
use crate::generate::injection::{HostModel, InjectionContext, InjectionError};
use crate::generate::machine::{Machine, Table};
use crate::generate::stream::{Purpose, stream};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use switchback_identify::free::Model;
use switchback_model::hysteresis::{Branch, Interval, SwitchedHysteresis};
use switchback_model::record::Record;
use switchback_model::rig::{Rig, RigRecord, Usage};

/// A measured rig, with the models that were identified from it.
#[derive(Debug)]
struct MeasuredBase {
    name: String,
    rig: Rig,
    /// What the rig is said to be.
    nominal: Model,
    /// A larger one that carries faults.
    host: Model,
}

/// Measured rigs, ready to be bases. Without any, a population is made throughout.
#[derive(Debug, Default)]
pub struct MeasuredBases(Vec<MeasuredBase>);

impl MeasuredBases {
    /// Identifies the models of rigs with their names; those that give none stand beside, each with its reason.
    pub fn identified(rigs: Vec<(String, Rig)>) -> (Self, Vec<(String, InjectionError)>) {
        let of = |(name, rig): (String, Rig)| match InjectionContext::new(&rig) {
            Ok(context) => {
                let (nominal, host) = (context.identified().model.clone(), context.host().clone());
                Ok(MeasuredBase { name, rig, nominal, host })
            }
            Err(error) => Err((name, error)),
        };
        let all: Vec<_> = rigs.into_par_iter().with_max_len(1).map(of).collect();
        let (mut bases, mut refused) = (Vec::new(), Vec::new());
        for one in all {
            match one {
                Ok(base) => bases.push(base),
                Err(reason) => refused.push(reason),
            }
        }
        (Self(bases), refused)
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Their names.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.0.iter().map(|base| base.name.as_str())
    }

    /// A setup of windows of a rig's records, resampled residuals `quieter` times smaller; none where a model has no loop there.
    pub(super) fn setup(&self, family: Family, seed: u64, quieter: f64) -> Option<Setup> {
        let mut rng = stream(seed, Purpose::Base);
        let base = &self.0[rng.random_range(0..self.0.len())];
        let rig = windows(&base.rig, &mut rng)?;
        match family {
            Family::Resampled => resampled_setup(base, &rig, (seed, quieter), &mut rng),
            _ => measured_setup(base, &rig, seed),
        }
    }
}

/// One to four windows of the records, one of them of what is held out.
fn windows(rig: &Rig, rng: &mut ChaCha8Rng) -> Option<Rig> {
    let fit: Vec<&RigRecord> = rig.fit_records().collect();
    let held_out: Vec<&RigRecord> = rig.holdout_records().collect();
    let count = rng.random_range(1..4);
    let whole = rng.random_bool(0.1);
    let mut records = Vec::new();
    for number in 0..=count {
        let (from, usage) = if number < count { (&fit, Usage::Fit) } else { (&held_out, Usage::Holdout) };
        let source = *from.get(rng.random_range(0..from.len().max(1)))?;
        let length = log_uniform(rng, 400.0, 3500.0) as usize;
        let length = if whole { source.record.len() } else { length.min(source.record.len()) };
        let start = rng.random_range(0..=source.record.len() - length);
        let cut = |x: &[f64]| x[start..start + length].to_vec();
        let record = Record::new(cut(source.record.v()), cut(source.record.y())).ok()?;
        let name = format!("{}-{}", source.name, number + 1);
        records.push(RigRecord { name, usage, record, predicted: None, ..source.clone() });
    }
    Some(Rig { records, ..rig.clone() })
}

/// The records as they were measured.
fn measured_setup(base: &MeasuredBase, rig: &Rig, seed: u64) -> Option<Setup> {
    let HostModel { machine, passages, .. } = HostModel::of(rig, &base.host).ok()?;
    let run = |(passage, record): (Passage, &RigRecord)| Run {
        passage,
        v: record.record.v().to_vec(),
        measured: Some(record.record.y().to_vec()),
        nominal: base.nominal.free_run(&record.record).y,
    };
    let runs: Vec<Run> = passages.into_iter().zip(&rig.records).map(run).collect();
    Some(setup(Family::Measured, base, rig, (machine, runs, seed)))
}

/// The machine changed, or another one, on the measured input, with the nominal model's residuals in another order.
fn resampled_setup(
    base: &MeasuredBase,
    rig: &Rig,
    (seed, quieter): (u64, f64),
    rng: &mut ChaCha8Rng,
) -> Option<Setup> {
    let host = HostModel::of(rig, &base.host).ok()?;
    let threshold = base.nominal.rule().threshold;
    let (machine, passages) = if rng.random_bool(0.35) {
        let machine = other(rig, &host.machine, rng)?;
        let passages = passages(rig, &machine, (0, threshold));
        (machine, passages)
    } else {
        (near(&host.machine, rng)?, host.passages)
    };
    let anew = resampled(rig, runs_of(&base.nominal), scramble(seed, 1)).ok()?;
    let louder = quieter * log_uniform(rng, 0.4, 2.0);
    let noise = machine.noise_sd * louder;
    let runs: Vec<Run> = passages
        .into_iter()
        .zip(&anew.records)
        .map(|(passage, record)| Run {
            passage,
            v: record.record.v().to_vec(),
            measured: None,
            nominal: Vec::new(),
        })
        .collect();
    let mut setup = setup(Family::Resampled, base, rig, (machine, runs, seed));
    made::finish(&mut setup);
    setup.machine.noise_sd = noise;
    let scale = spread(&setup.runs) / deviation(rig);
    for (run, record) in setup.runs.iter_mut().zip(&anew.records) {
        let simulated = base.nominal.free_run(&record.record);
        let left =
            record.record.y().iter().zip(&simulated.y).map(|(y, simulated)| louder * scale * (y - simulated));
        run.measured = Some(run.nominal.iter().zip(left).map(|(y, r)| y + r).collect());
    }
    setup.noise = residual(&setup.runs) / spread(&setup.runs);
    Some(setup)
}

fn setup(
    family: Family,
    base: &MeasuredBase,
    rig: &Rig,
    (machine, runs, seed): (Machine, Vec<Run>, u64),
) -> Setup {
    let noise = residual(&runs) / spread(&runs);
    Setup {
        family,
        base: base.name.clone(),
        machine,
        own: Vec::new(),
        runs,
        seed,
        order: base.nominal.structure().order.max(1),
        declared: None,
        labels: (rig.input_label.clone(), rig.output_label.clone()),
        borders: "measured",
        noise,
    }
}

/// Root mean square of what the nominal prediction leaves of the measured output.
fn residual(runs: &[Run]) -> f64 {
    let pairs = runs.iter().flat_map(|t| t.measured.iter().flatten().zip(&t.nominal));
    let (sum, count) = pairs.fold((0.0, 0.0), |(s, n), (y, p)| (s + (y - p).powi(2), n + 1.0));
    (sum / f64::max(count, 1.0)).sqrt()
}

fn deviation(rig: &Rig) -> f64 {
    let all = || rig.records.iter().flat_map(|r| r.record.y());
    let count = all().count() as f64;
    let mean = all().sum::<f64>() / count;
    (all().map(|y| (y - mean).powi(2)).sum::<f64>() / count).sqrt()
}

/// A machine near another: slower or faster poles, other gain, other width of the loop, bent borders.
fn near(machine: &Machine, rng: &mut ChaCha8Rng) -> Option<Machine> {
    let (low, width) = (machine.interval.low(), machine.interval.width());
    let places: Vec<f64> = (0..PLACES).map(|i| low + width * i as f64 / (PLACES - 1) as f64).collect();
    let border = |branch, v: &f64| machine.hysteresis.border(branch, *v);
    let bend = log_uniform(rng, 0.005, 0.12);
    let (of_middle, of_half) = (smooth(rng), smooth(rng));
    let wider = log_uniform(rng, 0.6, 1.7);
    let (mut ascending, mut descending) = (Vec::new(), Vec::new());
    for (i, v) in places.iter().enumerate() {
        let (up, down) = (border(Branch::Ascending, v), border(Branch::Descending, v));
        let (middle, half) = (0.5 * (up + down) + bend * of_middle[i], 0.5 * (up - down));
        let half = half * wider * (1.0 + 2.0 * bend * of_half[i]);
        ascending.push(middle + half);
        descending.push(middle - half);
    }
    let span = ascending[PLACES - 1] - descending[0];
    if span.abs() < 0.2 {
        return None;
    }
    ascending.iter_mut().chain(&mut descending).for_each(|u| *u /= span);
    let table = Table { levels: places, ascending, descending };
    let hysteresis = SwitchedHysteresis::new(machine.interval, Box::new(table)).ok()?;
    // Aᵢ·ρⁱ moves every pole along its ray.
    let rho = rng.random_range(0.9..1.003_f64);
    let a: Vec<f64> = machine.a.iter().zip(1..).map(|(a, i)| a * rho.powi(i)).collect();
    let stationary = |a: &[f64]| 1.0 + a.iter().sum::<f64>();
    let gain = span * stationary(&a) / stationary(&machine.a) * log_uniform(rng, 0.7, 1.4);
    let b = machine.b.iter().map(|b| b * gain).collect();
    let changed = Machine { a, b, hysteresis, curved: true, ..machine.clone() };
    (changed.settling() < 2000).then_some(changed)
}

/// A machine of wide draws on the range of a rig's input, as large as the measured output.
fn other(rig: &Rig, host: &Machine, rng: &mut ChaCha8Rng) -> Option<Machine> {
    let all = || rig.records.iter().flat_map(|r| r.record.v().iter().copied());
    let interval = Interval::new(all().fold(f64::MAX, f64::min), all().fold(f64::MIN, f64::max)).ok()?;
    let mut parts = made::parts(rng);
    parts.interval = interval;
    parts.gain = host.gain().abs() * one_of(rng, &[-1.0, 1.0, 1.0, 1.0]);
    let machine = Machine { sample_time: rig.sample_time, ..parts.machine()? };
    Some(Machine { noise_sd: host.noise_sd, ..machine })
}
