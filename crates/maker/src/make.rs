//! Making a rig.

use crate::campaign::{Passage, Plan, campaign};
use crate::effects::laws_of;
use crate::key::{Key, TrueEffect, Truth};
use crate::law::{Dose, Law, Nature};
use crate::plant::{Family, Plant};
use crate::refit::{Leftover, Refit};
use crate::simulate::{Active, Noise, Trace, simulate};
use crate::size::magnitude_for;
use crate::stream::{Purpose, stream};
use rand::RngExt;
use switchback_estimator::record::{Record, RecordError};
use switchback_estimator::rig::{Rig, RigRecord};
use thiserror::Error;

/// Why no rig could be made.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum MakeError {
    /// The effect's name is unknown.
    #[error("`{name}` is no effect; known are {known}")]
    UnknownEffect {
        /// The name given.
        name: String,
        /// All names, comma-separated.
        known: String,
    },
    /// The effect has fewer laws.
    #[error("`{effect}` has {laws} laws, numbered from 0; law {law} does not exist")]
    UnknownLaw {
        /// The effect.
        effect: String,
        /// Laws it has.
        laws: usize,
        /// The law asked for.
        law: usize,
    },
    /// The size is no size.
    #[error(
        "an effect of size {0} cannot be made; the size is a number of noise standard deviations above 0"
    )]
    Size(f64),
    /// The key belongs to another recipe.
    #[error("the key is of the rig with seed {key} and its effects, not of this recipe with seed {recipe}")]
    ForeignKey {
        /// Seed of the recipe.
        recipe: u64,
        /// Seed in the key.
        key: u64,
    },
    /// A simulated signal was no record.
    #[error("the drawn system and effect gave no finite record ({0}); take another seed")]
    Record(#[from] RecordError),
}

/// An effect to be put into a rig.
#[derive(Debug, Clone, Copy)]
pub struct Ingredient {
    law: &'static dyn Law,
    plain: bool,
    size: f64,
}

impl Ingredient {
    /// The plain law of an effect, at a size in noise standard deviations.
    ///
    /// # Errors
    /// [`MakeError::UnknownEffect`] or [`MakeError::Size`].
    pub fn plain(effect: &str, size: f64) -> Result<Self, MakeError> {
        Self::with_law(effect, 0, size)
    }

    /// The `law`-th law of an effect (0 is the plain one).
    ///
    /// # Errors
    /// [`MakeError::UnknownEffect`], [`MakeError::UnknownLaw`] or [`MakeError::Size`].
    pub fn with_law(effect: &str, law: usize, size: f64) -> Result<Self, MakeError> {
        let laws = laws_of(effect);
        if laws.is_empty() {
            let known = crate::EFFECTS.iter().chain(&crate::FOREIGN).copied().collect::<Vec<_>>().join(", ");
            return Err(MakeError::UnknownEffect { name: effect.to_owned(), known });
        }
        if !(size.is_finite() && size > 0.0) {
            return Err(MakeError::Size(size));
        }
        let chosen = laws.get(law).ok_or_else(|| MakeError::UnknownLaw {
            effect: effect.to_owned(),
            laws: laws.len(),
            law,
        })?;
        Ok(Self { law: *chosen, plain: law == 0, size })
    }
}

/// A recipe: everything else about the rig is drawn from the seed.
#[derive(Debug, Clone)]
pub struct MakeRig {
    seed: u64,
    family: Family,
    plan: Plan,
    ingredients: Vec<Ingredient>,
}

/// A rig and, apart from it, its key.
#[derive(Debug)]
pub struct MadeRig {
    /// What a user's folder would hold.
    pub rig: Rig,
    /// What is withheld.
    pub key: Key,
    /// What is true of each record, in the rig's order.
    pub truth: Vec<Truth>,
}

impl MakeRig {
    /// A rig without any effect, of the default plan and of no particular family.
    pub fn new(seed: u64) -> Self {
        Self {
            seed,
            family: Family { order: None, shape: None },
            plan: Plan::default(),
            ingredients: Vec::new(),
        }
    }

    /// Fixes order or border shape.
    #[must_use]
    pub fn family(mut self, family: Family) -> Self {
        self.family = family;
        self
    }

    /// Another plan of records.
    #[must_use]
    pub fn plan(mut self, plan: Plan) -> Self {
        self.plan = plan;
        self
    }

    /// Adds an effect.
    #[must_use]
    pub fn with(mut self, ingredient: Ingredient) -> Self {
        self.ingredients.push(ingredient);
        self
    }

    /// Draws the system and the inputs, sizes each effect by itself, and takes the records.
    ///
    /// # Errors
    /// [`MakeError::Record`] if the output is not finite.
    pub fn make(&self) -> Result<MadeRig, MakeError> {
        let mut workshop = self.workshop();
        let (active, mut effects): (Vec<_>, Vec<_>) =
            self.ingredients.iter().enumerate().map(|(slot, i)| workshop.sized(slot, i)).unzip();
        if let ([one], [entry]) = (active.as_slice(), effects.as_mut_slice()) {
            workshop.tune_noise(one, entry);
        }
        workshop.assemble(&active, effects)
    }

    /// The same rig once more from its key, without searching for the magnitudes: equal to the bit, and much faster.
    ///
    /// # Errors
    /// [`MakeError::ForeignKey`] if the key belongs to another recipe, [`MakeError::Record`] as in [`MakeRig::make`].
    pub fn again(&self, key: &Key) -> Result<MadeRig, MakeError> {
        let same_effect =
            |(i, e): (&Ingredient, &TrueEffect)| i.law.effect() == e.effect && i.law.name() == e.law;
        let same_count = self.ingredients.len() == key.effects.len();
        if self.seed != key.seed || !same_count || !self.ingredients.iter().zip(&key.effects).all(same_effect)
        {
            return Err(MakeError::ForeignKey { recipe: self.seed, key: key.seed });
        }
        let mut workshop = self.workshop();
        workshop.plant.noise_sd = key.noise_sd;
        let sized = self.ingredients.iter().zip(&key.effects).enumerate();
        let active: Vec<Active> =
            sized.map(|(slot, (i, e))| workshop.active(slot, i.law, e.magnitude)).collect();
        workshop.assemble(&active, key.effects.clone())
    }

    /// The system and the campaign of the recipe.
    fn workshop(&self) -> Workshop {
        let plant = Plant::draw(self.family, &mut stream(self.seed, Purpose::Plant));
        let passages = campaign(&self.plan, &plant, &mut stream(self.seed, Purpose::Drive));
        let refit = Refit::new(&plant, &passages);
        let mut workshop = Workshop { plant, passages, refit, seed: self.seed };
        workshop.measure_reach();
        workshop
    }
}

/// A system with its campaign, on which effects are tried.
struct Workshop {
    plant: Plant,
    passages: Vec<Passage>,
    refit: Refit,
    seed: u64,
}

/// All passages with some effects, and what the nominal re-fit leaves of them.
struct Trial {
    traces: Vec<Trace>,
    leftover: Leftover,
    size: f64,
}

impl Workshop {
    /// Runs the nominal rig once, without noise, to learn what its output reaches.
    fn measure_reach(&mut self) {
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
            if passage.usage == switchback_estimator::rig::Usage::Fit {
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
    fn active(&self, slot: usize, law: &'static dyn Law, magnitude: f64) -> Active {
        let mut rng = stream(self.seed, Purpose::Shape(slot));
        Active { law, dose: Dose { magnitude, shape: std::array::from_fn(|_| rng.random()) }, slot }
    }

    /// Finds the magnitude of one effect, alone in the rig.
    fn sized(&self, slot: usize, ingredient: &Ingredient) -> (Active, TrueEffect) {
        let law = ingredient.law;
        let active = |magnitude: f64| self.active(slot, law, magnitude);
        let found = magnitude_for(ingredient.size, law.limit(), |x| self.trial(&[active(x)]).size);
        let entry = TrueEffect {
            effect: law.effect(),
            law: law.name(),
            plain: ingredient.plain,
            stage: law.stage(),
            nature: law.nature(),
            magnitude: found.magnitude,
            unit: law.unit(),
            wanted: ingredient.size,
            size: found.size,
        };
        (active(found.magnitude), entry)
    }

    /// Where the magnitude alone could not bring the size, the noise may: a size is a ratio of the two.
    ///
    /// A gap that is smaller than the shortest move, or an effect at its limit, leaves no magnitude that fits. The rig
    /// then becomes up to eight times quieter or louder. Magnitudes that count noise sds would scale along and stay.
    fn tune_noise(&mut self, one: &Active, entry: &mut TrueEffect) {
        const ROUNDS: usize = 4;
        const RANGE: f64 = 8.0;
        if one.law.nature() == Nature::Noise || one.law.unit() == "noise sd" {
            return;
        }
        let drawn = self.plant.noise_sd;
        for _ in 0..ROUNDS {
            if (entry.size / entry.wanted - 1.0).abs() < 0.02 {
                return;
            }
            let scale = self.plant.noise_sd / drawn * entry.size / entry.wanted;
            self.plant.noise_sd = drawn * scale.clamp(1.0 / RANGE, RANGE);
            entry.size = self.trial(std::slice::from_ref(one)).size;
        }
    }

    fn assemble(&self, active: &[Active], effects: Vec<TrueEffect>) -> Result<MadeRig, MakeError> {
        let trial = self.trial(active);
        let repeating = self.traces(active, Noise::None);
        let mut records = Vec::with_capacity(self.passages.len());
        let mut truth = Vec::with_capacity(self.passages.len());
        for (i, passage) in self.passages.iter().enumerate() {
            let trace = &trial.traces[i];
            let record =
                Record::new(passage.recorded(&passage.v).to_vec(), passage.recorded(&trace.y).to_vec())?;
            records.push(RigRecord {
                name: passage.name.to_owned(),
                role: passage.role,
                usage: passage.usage,
                record,
                predicted: None,
            });
            let first = trial.leftover.first[i];
            let white = passage.recorded(&trace.white);
            let surviving = trial.leftover.residuals[i].iter().zip(white).enumerate();
            truth.push(Truth {
                record: passage.name.to_owned(),
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
            noise_sd: self.plant.noise_sd,
            effects,
            size: trial.size,
        };
        Ok(MadeRig { rig, key, truth })
    }
}
