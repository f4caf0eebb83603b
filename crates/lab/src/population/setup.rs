//! A machine with its records, ready for causes.

use super::family::Family;
use crate::generate::Passage;
use crate::generate::injection::alter::alter;
use crate::generate::injection::host_model::quiet;
use crate::generate::law::{Injection, Scene};
use crate::generate::machine::Machine;
use crate::generate::simulate::{Active, Noise, simulate};
use crate::generate::stream::{Purpose, stream};
use switchback_model::hysteresis::Interval;
use switchback_model::record::{Record, RecordError};
use switchback_model::rig::{Rig, RigRecord};

/// One run of an experiment.
#[derive(Debug)]
pub(super) struct Run {
    /// The input that acts, lead-in first.
    pub passage: Passage,
    /// The recorded input before a recorder changes it, lead-in left out.
    pub v: Vec<f64>,
    /// The measured output, where there is one.
    pub measured: Option<Vec<f64>>,
    /// What the machine's own model predicts, noise and errors left out.
    pub nominal: Vec<f64>,
}

/// Input and output of a record.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Signals {
    pub v: Vec<f64>,
    pub y: Vec<f64>,
    /// Change of the nominal prediction by a changed record of the input.
    pub moved: Option<Vec<f64>>,
}

/// Slots of what a machine has by itself begin here: far beyond those of causes, so that their random streams never meet.
pub(super) const OWN_SLOTS: usize = 1 << 13;

/// Moves of the input below so many standard deviations of its recorder's noise are none.
const THRESHOLD: f64 = 6.0;

/// A machine with its records, ready for causes.
#[derive(Debug)]
pub(super) struct Setup {
    pub family: Family,
    /// Name of the base: the measured rig's, or the family's.
    pub base: String,
    pub machine: Machine,
    /// What the machine has beside its nominal system.
    pub own: Vec<Active>,
    pub runs: Vec<Run>,
    pub seed: u64,
    /// Order that identification anew has.
    pub order: usize,
    /// Order and interval where the rig file states them.
    pub declared: Option<(usize, Interval)>,
    pub labels: (String, String),
    /// Kind of borders, and the noise as a share of the output's standard deviation.
    pub borders: &'static str,
    pub noise: f64,
}

impl Setup {
    /// The records with some causes.
    pub(super) fn signals(&self, active: &[Active]) -> Vec<Signals> {
        self.runs.iter().map(|run| self.signals_of(run, active)).collect()
    }

    fn signals_of(&self, run: &Run, active: &[Active]) -> Signals {
        match &run.measured {
            Some(y) => self.altered(run, y, active),
            None => self.simulated(run, active),
        }
    }

    fn simulated(&self, run: &Run, active: &[Active]) -> Signals {
        let all = [&self.own, active].concat();
        let trace = simulate(&self.machine, &all, &run.passage, self.seed, Noise::Recorded);
        let mut v = run.v.clone();
        for Active { law, amount, slot } in &self.own {
            let rng = stream(self.seed, Purpose::Effect { effect: *slot, record: run.passage.index });
            let mut scene = Scene { machine: &self.machine, passage: &run.passage, amount: *amount, rng };
            law.recording(&mut scene, &mut v);
        }
        Signals { v, y: run.passage.recorded(&trace.y).to_vec(), moved: None }
    }

    fn altered(&self, run: &Run, measured: &[f64], active: &[Active]) -> Signals {
        let (mut v, mut y) = (run.v.clone(), measured.to_vec());
        let mut acting = run.passage.recorded(&run.passage.v).to_vec();
        let mut is_moved = false;
        for one in active {
            alter(&self.machine, &run.passage, (one, self.seed), (&mut v, &mut y));
            if one.law.injection() == Injection::Recording {
                let mut none = y.clone();
                alter(&self.machine, &run.passage, (one, self.seed), (&mut acting, &mut none));
                is_moved = true;
            }
        }
        let moved = is_moved.then(|| self.moved(&run.passage, acting));
        Signals { v, y, moved }
    }

    /// Change of the machine's output where another input acts.
    fn moved(&self, passage: &Passage, acting: Vec<f64>) -> Vec<f64> {
        let mut other = passage.clone();
        let first = other.v.len() - acting.len();
        other.v.splice(first.., acting);
        let run = |passage: &Passage| {
            passage.recorded(&simulate(&self.machine, &[], passage, self.seed, Noise::None).y).to_vec()
        };
        run(&other).iter().zip(run(passage)).map(|(with, without)| with - without).collect()
    }

    /// What identification has to explain: of measured records what the nominal prediction leaves; of made ones the output, since borders on a
    /// grid of knots are no more than close to the true ones, less what the recorder of the input does to a simulation.
    pub(super) fn unexplained(&self, before: &[Signals]) -> Vec<Vec<f64>> {
        let one = |(run, signals): (&Run, &Signals)| -> Vec<f64> {
            if run.measured.is_some() {
                return signals.y.iter().zip(&run.nominal).map(|(y, n)| y - n).collect();
            }
            let recorder: Vec<f64> = signals.v.iter().zip(&run.v).map(|(r, v)| r - v).collect();
            let rms = (recorder.iter().map(|d| d * d).sum::<f64>() / recorder.len() as f64).sqrt();
            if rms == 0.0 {
                return signals.y.clone();
            }
            let acting = run.passage.recorded(&run.passage.v).iter().zip(&recorder).map(|(v, d)| v + d);
            let acting = quiet(&acting.collect::<Vec<f64>>(), THRESHOLD * rms);
            let moved = self.moved(&run.passage, acting);
            signals.y.iter().zip(moved).map(|(y, m)| y - m).collect()
        };
        self.runs.iter().zip(before).map(one).collect()
    }

    /// The rig that these signals make.
    ///
    /// # Errors
    /// [`RecordError`] where a signal is not finite.
    pub(super) fn rig(
        &self,
        signals: &[Signals],
        predicted: Option<Vec<Vec<f64>>>,
    ) -> Result<Rig, RecordError> {
        let mut predicted = predicted.map(Vec::into_iter);
        let record = |(run, signals): (&Run, &Signals)| {
            Ok(RigRecord {
                name: run.passage.name.clone(),
                role: run.passage.role,
                usage: run.passage.usage,
                record: Record::new(signals.v.clone(), signals.y.clone())?,
                predicted: predicted.as_mut().and_then(Iterator::next),
            })
        };
        let (input_label, output_label) = self.labels.clone();
        Ok(Rig {
            name: "rig".to_owned(),
            sample_time: self.machine.sample_time,
            order: self.declared.map(|(order, _)| order),
            interval: self.declared.map(|(_, interval)| interval),
            input_label,
            output_label,
            records: self.runs.iter().zip(signals).map(record).collect::<Result<_, _>>()?,
        })
    }

    /// Change of every record's residual from one state of the machine to another.
    pub(super) fn change(before: &[Signals], after: &[Signals]) -> Vec<Vec<f64>> {
        let one = |(before, after): (&Signals, &Signals)| {
            let mut change: Vec<f64> = after.y.iter().zip(&before.y).map(|(y, b)| y - b).collect();
            if let Some(moved) = &after.moved {
                change.iter_mut().zip(moved).for_each(|(c, m)| *c -= m);
            }
            change
        };
        before.iter().zip(after).map(one).collect()
    }
}

/// Standard deviation of the nominal output over all records.
pub(super) fn spread(runs: &[Run]) -> f64 {
    let all = || runs.iter().flat_map(|t| &t.nominal);
    let count = all().count() as f64;
    let mean = all().sum::<f64>() / count;
    (all().map(|y| (y - mean).powi(2)).sum::<f64>() / count).sqrt()
}
