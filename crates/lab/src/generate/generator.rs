//! A system with its dataset, on which effects are tried.

use crate::generate::dataset::Passage;
use crate::generate::key::{Key, TrueEffect, Truth};
use crate::generate::law::{Amount, Law, Nature, Scene};
use crate::generate::machine::Machine;
use crate::generate::made_rig::MadeRig;
use crate::generate::make_error::MakeError;
use crate::generate::refit::{Leftover, Refit};
use crate::generate::requested_fault::RequestedFault;
use crate::generate::setting::Setting;
use crate::generate::simulate::{Active, Noise, Trace, simulate};
use crate::generate::size::magnitude_for;
use crate::generate::stream::{Purpose, stream};
use rand::RngExt;
use switchback_model::hysteresis::Interval;
use switchback_model::record::{Record, RecordError};
use switchback_model::rig::{Rig, RigRecord, Usage};

/// The description of a machine: the public part and that of the key.
pub(crate) struct Description {
    pub setting: Setting,
    /// Order and interval, where they are declared.
    pub order: Option<usize>,
    pub interval: Option<Interval>,
    /// Labels of the signals.
    pub input: String,
    pub output: String,
    /// Names of what the machine has by itself.
    pub base: Vec<&'static str>,
}

/// A system with its dataset, on which effects are tried.
pub(crate) struct Generator {
    pub machine: Machine,
    /// What the system has before any effect is put in.
    base: Vec<Active>,
    description: Description,
    pub passages: Vec<Passage>,
    pub refit: Refit,
    pub seed: u64,
}

/// All passages with some effects, and what the nominal re-fit leaves of them.
struct Trial {
    traces: Vec<Trace>,
    leftover: Leftover,
}

impl Generator {
    /// Lays out the re-fit of a system with what it has by itself, and learns what its output reaches.
    pub(crate) fn new(
        seed: u64,
        (machine, base): (Machine, Vec<Active>),
        passages: Vec<Passage>,
        description: Description,
    ) -> Self {
        let refit = Refit::new(&machine, &passages);
        let mut generator = Self { machine, base, description, passages, refit, seed };
        generator.measure_reach();
        generator
    }

    /// What the system has before any effect is put in.
    pub(crate) fn base(&self) -> &[Active] {
        &self.base
    }

    /// Runs the nominal rig once, without noise, to learn what its output reaches.
    fn measure_reach(&mut self) {
        let centre = self.machine.y_centre();
        let outputs = self.recorded(&self.traces(&[], Noise::None));
        self.machine.reach = outputs.iter().flatten().fold(0.0, |most, y| f64::max(most, (y - centre).abs()));
    }

    fn traces(&self, active: &[Active], noise: Noise) -> Vec<Trace> {
        let all = [&self.base, active].concat();
        self.passages.iter().map(|p| simulate(&self.machine, &all, p, self.seed, noise)).collect()
    }

    fn recorded(&self, traces: &[Trace]) -> Vec<Vec<f64>> {
        self.passages.iter().zip(traces).map(|(p, t)| p.recorded(&t.y).to_vec()).collect()
    }

    fn trial(&self, active: &[Active]) -> Trial {
        let traces = self.traces(active, Noise::Recorded);
        let leftover = self.refit.solve(&self.passages, &self.recorded(&traces));
        Trial { traces, leftover }
    }

    /// The size of effects in the laboratory.
    fn size(&self, active: &[Active], Trial { traces, leftover }: &Trial) -> f64 {
        // The realised noise, not σ², so that its sampling error cancels.
        let (mut sum, mut count) = (0.0, 0_usize);
        for ((passage, trace), first) in self.passages.iter().zip(traces).zip(&leftover.first) {
            if passage.usage == Usage::Fit {
                let white = &passage.recorded(&trace.white)[*first..];
                sum += white.iter().map(|w| w * w).sum::<f64>();
                count += white.len();
            }
        }
        let oracle: f64 = active.iter().map(|e| e.law.oracle_variance(&self.machine, &e.amount)).product();
        let ratio = leftover.variance / (oracle * sum / count as f64);
        (ratio - 1.0).max(0.0).sqrt()
    }

    /// A law at a magnitude; its shape numbers are the rig's.
    pub(crate) fn active(&self, slot: usize, law: &'static dyn Law, magnitude: f64) -> Active {
        let mut rng = stream(self.seed, Purpose::Shape(slot));
        Active { law, amount: Amount { magnitude, shape: std::array::from_fn(|_| rng.random()) }, slot }
    }

    fn size_of(&self, active: &[Active]) -> f64 {
        self.size(active, &self.trial(active))
    }

    /// Finds the magnitude of one effect, alone in the rig.
    pub(crate) fn sized(&self, slot: usize, requested_fault: &RequestedFault) -> (Active, TrueEffect) {
        let law = requested_fault.law;
        let active = |magnitude: f64| self.active(slot, law, magnitude);
        let found = magnitude_for(requested_fault.size, law.limit(), |x| self.size_of(&[active(x)]));
        (active(found.magnitude), requested_fault.found(found.magnitude, found.size))
    }

    /// Where the magnitude alone does not bring the size, the noise may: a size is a ratio of the two.
    ///
    /// A gap shorter than any move, or an effect at its limit, leaves no sensible magnitude that fits; the rig then
    /// becomes quieter or louder, between 0.02 % and 6 % of its stationary span in the output. Magnitudes that count
    /// noise sds would scale along and stay.
    pub(crate) fn tune_noise(&mut self, one: &mut Active, entry: &mut TrueEffect) {
        const ROUNDS: usize = 4;
        if one.law.nature() == Nature::Noise || one.law.counts_noise() {
            return;
        }
        if one.amount.magnitude < one.law.least() {
            one.amount.magnitude = one.law.least();
            entry.size = self.size_of(std::slice::from_ref(one));
        }
        let span = 2.0 * self.machine.y_half() / self.machine.noise_amplification();
        for _ in 0..ROUNDS {
            if (entry.size / entry.wanted - 1.0).abs() < 0.02 {
                break;
            }
            self.machine.noise_sd =
                (self.machine.noise_sd * entry.size / entry.wanted).clamp(2e-4 * span, 0.06 * span);
            entry.size = self.size_of(std::slice::from_ref(one));
        }
        if entry.size > 1.05 * entry.wanted {
            let amount = |magnitude: f64| Active { amount: Amount { magnitude, ..one.amount }, ..*one };
            let found = magnitude_for(entry.wanted, one.amount.magnitude, |x| self.size_of(&[amount(x)]));
            (one.amount.magnitude, entry.size) = (found.magnitude, found.size);
        }
        entry.magnitude = one.amount.magnitude;
    }

    /// What a user's folder would hold.
    pub(crate) fn rig(&self, active: &[Active]) -> Result<Rig, RecordError> {
        self.rig_of(&self.traces(active, Noise::Recorded))
    }

    fn rig_of(&self, traces: &[Trace]) -> Result<Rig, RecordError> {
        let record = |(passage, trace): (&Passage, &Trace)| {
            let input = self.recorded_input(passage);
            Ok(RigRecord {
                name: passage.name.clone(),
                role: passage.role,
                usage: passage.usage,
                record: Record::new(input, passage.recorded(&trace.y).to_vec())?,
                predicted: None,
            })
        };
        Ok(Rig {
            name: format!("rig-{}", self.seed),
            sample_time: self.machine.sample_time,
            order: self.description.order,
            interval: self.description.interval,
            input_label: self.description.input.clone(),
            output_label: self.description.output.clone(),
            records: self.passages.iter().zip(traces).map(record).collect::<Result<_, RecordError>>()?,
        })
    }

    /// The input of a passage, as the machine by itself records it.
    fn recorded_input(&self, passage: &Passage) -> Vec<f64> {
        let mut v = passage.v.clone();
        for Active { law, amount, slot } in &self.base {
            let rng = stream(self.seed, Purpose::Effect { effect: *slot, record: passage.index });
            law.recording(&mut Scene { machine: &self.machine, passage, amount: *amount, rng }, &mut v);
        }
        passage.recorded(&v).to_vec()
    }

    /// The rig with its key and its truth; `of_the_field` is the size of all effects where the machine is one of the field.
    pub(crate) fn assemble(
        &self,
        active: &[Active],
        effects: Vec<TrueEffect>,
        of_the_field: impl FnOnce(&Self, &[Active], &[TrueEffect]) -> Result<f64, MakeError>,
    ) -> Result<MadeRig, MakeError> {
        let trial = self.trial(active);
        let rig = self.rig_of(&trial.traces)?;
        let size = match self.description.setting {
            Setting::Laboratory => self.size(active, &trial),
            Setting::Field => of_the_field(self, active, &effects)?,
        };
        let truth = self.truth(active, &trial);
        let key = Key {
            seed: self.seed,
            order: self.machine.order(),
            a: self.machine.a.clone(),
            b: self.machine.b.clone(),
            borders: self.machine.shape.name(),
            curved: self.machine.curved,
            interval: self.machine.interval,
            noise_sd: self.machine.noise_sd,
            setting: self.description.setting,
            base: self.description.base.clone(),
            effects,
            size,
        };
        Ok(MadeRig { rig, key, truth })
    }

    fn truth(&self, active: &[Active], trial: &Trial) -> Vec<Truth> {
        let repeating = self.traces(active, Noise::None);
        let (expected, scale) = self.without_effects(trial);
        let of = |(i, passage): (usize, &Passage)| {
            let first = trial.leftover.first[i];
            let both = trial.leftover.residuals[i].iter().zip(&expected[i]).enumerate();
            Truth {
                record: passage.name.clone(),
                repeating: passage.recorded(&repeating[i].y).to_vec(),
                surviving: both.map(|(t, (r, w))| if t < first { 0.0 } else { (r - w) / scale }).collect(),
                first,
            }
        };
        self.passages.iter().enumerate().map(of).collect()
    }

    /// What the re-fit would leave of each record if there were no effects, and its standard deviation: of a nominal system the white
    /// equation error.
    fn without_effects(&self, trial: &Trial) -> (Vec<Vec<f64>>, f64) {
        match self.description.setting {
            Setting::Laboratory => {
                let white = |(p, t): (&Passage, &Trace)| p.recorded(&t.white).to_vec();
                (self.passages.iter().zip(&trial.traces).map(white).collect(), self.machine.noise_sd)
            }
            Setting::Field => {
                let base = self.trial(&[]).leftover;
                (base.residuals, base.variance.sqrt())
            }
        }
    }
}
