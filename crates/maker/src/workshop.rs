//! A system with its campaign, on which effects are tried.

use crate::campaign::Passage;
use crate::key::{Key, TrueEffect, Truth};
use crate::law::{Dose, Law, Nature};
use crate::make::{Ingredient, MadeRig, MakeError};
use crate::plant::Plant;
use crate::refit::{Leftover, Refit};
use crate::simulate::{Active, Noise, Trace, simulate};
use crate::size::magnitude_for;
use crate::stream::{Purpose, stream};
use rand::RngExt;
use switchback_estimator::record::Record;
use switchback_estimator::rig::{Rig, RigRecord, Usage};

/// A system with its campaign, on which effects are tried.
pub(crate) struct Workshop {
    pub(crate) plant: Plant,
    pub(crate) passages: Vec<Passage>,
    pub(crate) refit: Refit,
    pub(crate) seed: u64,
}

/// All passages with some effects, and what the nominal re-fit leaves of them.
struct Trial {
    traces: Vec<Trace>,
    leftover: Leftover,
    size: f64,
}

impl Workshop {
    /// Runs the nominal rig once, without noise, to learn what its output reaches.
    pub(crate) fn measure_reach(&mut self) {
        let centre = self.plant.y_centre();
        let outputs = self.recorded(&self.traces(&[], Noise::None));
        self.plant.reach = outputs.iter().flatten().fold(0.0, |most, y| f64::max(most, (y - centre).abs()));
    }

    fn traces(&self, active: &[Active], noise: Noise) -> Vec<Trace> {
        self.passages.iter().map(|p| simulate(&self.plant, active, p, self.seed, noise)).collect()
    }

    fn recorded(&self, traces: &[Trace]) -> Vec<Vec<f64>> {
        self.passages.iter().zip(traces).map(|(p, t)| p.recorded(&t.y).to_vec()).collect()
    }

    fn trial(&self, active: &[Active]) -> Trial {
        let traces = self.traces(active, Noise::Recorded);
        let leftover = self.refit.solve(&self.passages, &self.recorded(&traces));
        // The realised noise, not σ², so that its sampling error cancels.
        let (mut sum, mut count) = (0.0, 0_usize);
        for (passage, trace) in self.passages.iter().zip(&traces) {
            if passage.usage == Usage::Fit {
                let white = &passage.recorded(&trace.white)[leftover.first[passage.index]..];
                sum += white.iter().map(|w| w * w).sum::<f64>();
                count += white.len();
            }
        }
        let oracle: f64 = active.iter().map(|e| e.law.oracle_variance(&self.plant, &e.dose)).product();
        let ratio = leftover.variance / (oracle * sum / count as f64);
        Trial { traces, leftover, size: (ratio - 1.0).max(0.0).sqrt() }
    }

    /// A law at a magnitude; its shape numbers are the rig's.
    pub(crate) fn active(&self, slot: usize, law: &'static dyn Law, magnitude: f64) -> Active {
        let mut rng = stream(self.seed, Purpose::Shape(slot));
        Active { law, dose: Dose { magnitude, shape: std::array::from_fn(|_| rng.random()) }, slot }
    }

    /// Finds the magnitude of one effect, alone in the rig.
    pub(crate) fn sized(&self, slot: usize, ingredient: &Ingredient) -> (Active, TrueEffect) {
        let law = ingredient.law;
        let active = |magnitude: f64| self.active(slot, law, magnitude);
        let found = magnitude_for(ingredient.size, law.limit(), |x| self.trial(&[active(x)]).size);
        (active(found.magnitude), ingredient.found(found.magnitude, found.size))
    }

    /// Where the magnitude alone does not bring the size, the noise may: a size is a ratio of the two.
    ///
    /// A gap shorter than any move, or an effect at its limit, leaves no sensible magnitude that fits; the rig then
    /// becomes quieter or louder, between 0.02 % and 6 % of its stationary span in the output. Magnitudes that count
    /// noise sds would scale along and stay.
    pub(crate) fn tune_noise(&mut self, one: &mut Active, entry: &mut TrueEffect) {
        const ROUNDS: usize = 4;
        if one.law.nature() == Nature::Noise || one.law.unit() == "noise sd" {
            return;
        }
        if one.dose.magnitude < one.law.least() {
            one.dose.magnitude = one.law.least();
            entry.size = self.trial(std::slice::from_ref(one)).size;
        }
        let span = 2.0 * self.plant.y_half() / self.plant.noise_amplification();
        for _ in 0..ROUNDS {
            if (entry.size / entry.wanted - 1.0).abs() < 0.02 {
                break;
            }
            self.plant.noise_sd =
                (self.plant.noise_sd * entry.size / entry.wanted).clamp(2e-4 * span, 0.06 * span);
            entry.size = self.trial(std::slice::from_ref(one)).size;
        }
        if entry.size > 1.05 * entry.wanted {
            let dose = |magnitude: f64| Active { dose: Dose { magnitude, ..one.dose }, ..*one };
            let found = magnitude_for(entry.wanted, one.dose.magnitude, |x| self.trial(&[dose(x)]).size);
            (one.dose.magnitude, entry.size) = (found.magnitude, found.size);
        }
        entry.magnitude = one.dose.magnitude;
    }

    pub(crate) fn assemble(&self, active: &[Active], effects: Vec<TrueEffect>) -> Result<MadeRig, MakeError> {
        let trial = self.trial(active);
        let repeating = self.traces(active, Noise::None);
        let mut records = Vec::with_capacity(self.passages.len());
        let mut truth = Vec::with_capacity(self.passages.len());
        for (i, passage) in self.passages.iter().enumerate() {
            let trace = &trial.traces[i];
            let record =
                Record::new(passage.recorded(&passage.v).to_vec(), passage.recorded(&trace.y).to_vec())?;
            records.push(RigRecord {
                name: passage.name.clone(),
                role: passage.role,
                usage: passage.usage,
                record,
                predicted: None,
            });
            let first = trial.leftover.first[i];
            let white = passage.recorded(&trace.white);
            let surviving = trial.leftover.residuals[i].iter().zip(white).enumerate();
            truth.push(Truth {
                record: passage.name.clone(),
                repeating: passage.recorded(&repeating[i].y).to_vec(),
                surviving: surviving
                    .map(|(t, (r, w))| if t < first { 0.0 } else { (r - w) / self.plant.noise_sd })
                    .collect(),
                first,
            });
        }
        let rig = Rig {
            name: format!("rig-{}", self.seed),
            sample_time: self.plant.sample_time,
            order: Some(self.plant.order()),
            interval: Some(self.plant.interval),
            input_label: "v".to_owned(),
            output_label: "y".to_owned(),
            records,
        };
        let key = Key {
            seed: self.seed,
            order: self.plant.order(),
            a: self.plant.a.clone(),
            b: self.plant.b.clone(),
            borders: self.plant.shape.name(),
            curved: self.plant.curved,
            noise_sd: self.plant.noise_sd,
            effects,
            size: trial.size,
        };
        Ok(MadeRig { rig, key, truth })
    }
}
