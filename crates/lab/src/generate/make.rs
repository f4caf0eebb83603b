//! Making a rig.

use crate::generate::dataset::{Plan, dataset};
use crate::generate::field;
use crate::generate::generator::{Description, Generator};
use crate::generate::key::{Key, TrueEffect};
use crate::generate::machine::{Family, Machine};
use crate::generate::made_rig::MadeRig;
use crate::generate::make_error::MakeError;
use crate::generate::requested_fault::RequestedFault;
use crate::generate::setting::Setting;
use crate::generate::simulate::Active;
use crate::generate::stream::{Purpose, stream};

/// A recipe: everything else about the rig is drawn from the seed.
#[derive(Debug, Clone)]
pub struct MakeRig {
    seed: u64,
    family: Family,
    plan: Plan,
    setting: Setting,
    requested_faults: Vec<RequestedFault>,
    /// Effects that the machine does not have by itself.
    spared: Vec<&'static str>,
}

impl MakeRig {
    /// A rig without any effect, of the default plan and of no particular family.
    pub fn new(seed: u64) -> Self {
        Self {
            seed,
            family: Family { order: None, shape: None },
            plan: Plan::default(),
            setting: Setting::default(),
            requested_faults: Vec::new(),
            spared: Vec::new(),
        }
    }

    /// Fixes order or border shape.
    #[must_use]
    pub fn family(mut self, family: Family) -> Self {
        self.family = family;
        self
    }

    /// Where the rig stands; the laboratory, if nothing is said.
    #[must_use]
    pub fn setting(mut self, setting: Setting) -> Self {
        self.setting = setting;
        self
    }

    /// Another plan of the laboratory's records; datasets in the field have none.
    #[must_use]
    pub fn plan(mut self, plan: Plan) -> Self {
        self.plan = plan;
        self
    }

    /// Adds an effect. A machine of the field that has it by itself loses that: what is put in is all of it.
    #[must_use]
    pub fn with(mut self, requested_fault: RequestedFault) -> Self {
        self.spared.push(requested_fault.law.effect());
        self.requested_faults.push(requested_fault);
        self
    }

    /// The same machine, inputs and noise without the effects that were added: what the rig was before.
    #[must_use]
    pub(crate) fn base(&self) -> Self {
        Self { requested_faults: Vec::new(), ..self.clone() }
    }

    /// Draws the system and the inputs, sizes each effect by itself, and takes the records.
    ///
    /// # Errors
    /// [`MakeError::Record`] if the output is not finite, [`MakeError::NoSize`] if an effect in the field has no size.
    pub fn make(&self) -> Result<MadeRig, MakeError> {
        let mut generator = self.generator();
        if self.setting == Setting::Field {
            let (active, effects) = field::sized(&generator, &self.requested_faults)?;
            return generator.assemble(&active, effects, field::size_of_all);
        }
        let (mut active, mut effects): (Vec<_>, Vec<_>) =
            self.requested_faults.iter().enumerate().map(|(slot, i)| generator.sized(slot, i)).unzip();
        if let ([one], [entry]) = (active.as_mut_slice(), effects.as_mut_slice()) {
            generator.tune_noise(one, entry);
        }
        generator.assemble(&active, effects, field::size_of_all)
    }

    /// The same rig once more from its key, without searching for the magnitudes: equal to the bit, and much faster.
    ///
    /// # Errors
    /// [`MakeError::ForeignKey`] if the key belongs to another recipe, [`MakeError::Record`] as in [`MakeRig::make`].
    pub fn again(&self, key: &Key) -> Result<MadeRig, MakeError> {
        let same_effect =
            |(i, e): (&RequestedFault, &TrueEffect)| i.law.effect() == e.effect && i.law.name() == e.law;
        let foreign = || MakeError::ForeignKey { recipe: self.seed, key: key.seed };
        let same_count = self.requested_faults.len() == key.effects.len();
        let same_effects = same_count && self.requested_faults.iter().zip(&key.effects).all(same_effect);
        if (self.seed, self.setting) != (key.seed, key.setting) || !same_effects {
            return Err(foreign());
        }
        let made = self.with_found(key.noise_sd, key.effects.clone())?;
        if made.key.base != key.base {
            return Err(foreign());
        }
        Ok(made)
    }

    /// The same rig once more from what a search found: standard deviation of the noise, magnitude and size of each effect. `None`
    /// where there are not as many as effects.
    ///
    /// # Errors
    /// [`MakeError::Record`] as in [`MakeRig::make`].
    pub(crate) fn made_with(
        &self,
        noise_sd: f64,
        found: &[(f64, f64)],
    ) -> Result<Option<MadeRig>, MakeError> {
        if found.len() != self.requested_faults.len() {
            return Ok(None);
        }
        let entries =
            self.requested_faults.iter().zip(found).map(|(i, (magnitude, size))| i.found(*magnitude, *size));
        self.with_found(noise_sd, entries.collect()).map(Some)
    }

    fn with_found(&self, noise_sd: f64, effects: Vec<TrueEffect>) -> Result<MadeRig, MakeError> {
        let mut generator = self.generator();
        generator.machine.noise_sd = noise_sd;
        let sized = self.requested_faults.iter().zip(&effects).enumerate();
        let active: Vec<Active> =
            sized.map(|(slot, (i, e))| generator.active(slot, i.law, e.magnitude)).collect();
        generator.assemble(&active, effects, field::size_of_all)
    }

    /// The system and the dataset of the recipe.
    pub(crate) fn generator(&self) -> Generator {
        if self.setting == Setting::Field {
            return field::generator(self.seed, self.family, &self.spared);
        }
        let machine = Machine::draw(self.family, &mut stream(self.seed, Purpose::Machine));
        let passages = dataset(&self.plan, &machine, &mut stream(self.seed, Purpose::Drive));
        let description = Description {
            setting: Setting::Laboratory,
            order: Some(machine.order()),
            interval: Some(machine.interval),
            input: "v".to_owned(),
            output: "y".to_owned(),
            base: Vec::new(),
        };
        Generator::new(self.seed, (machine, Vec::new()), passages, description)
    }
}
