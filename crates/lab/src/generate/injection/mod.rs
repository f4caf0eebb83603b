//! Known faults in measured records: noise, unlogged influences and the model's errors stay those of the machine.
//!
//! Some faults need no model ([`Injection`] says which): what the sensor makes of the output, a gain that changes slowly, what the record of
//! the input shows. All others are *carried*: a model of the machine, identified from its records with one pole and many knots more than
//! any candidate has, is simulated with the fault and without, and the difference is added to the measured output. That assumes that the
//! fault does not interact with what the model misses.
//!
//! The *size* of a fault is what survives identification anew, against what the base's own model leaves,
//!
//! ```text
//! size = rms(r' − r) / rms(r),   r = y − ŷ,   r' = y' − ŷ'
//! ```
//!
//! over the free runs on the held-out records (the fit records, where none are held out): `ŷ` is the model identified from the fit records
//! as they are, `ŷ'` one of the same order, delay and knots identified from those with the fault. The *raw* size has `ŷ` in place of `ŷ'`,
//! on the planted input: what a model given beforehand newly misses.

mod again;
pub(crate) mod alter;
mod base;
pub(crate) mod host_model;
mod injection_error;
mod search;

pub(crate) use self::base::Base;
pub(crate) use self::host_model::HostModel;
pub use self::injection_error::InjectionError;
pub(crate) use self::search::Goal;
pub use self::search::Precision;
pub(crate) use self::search::Trial;
pub(crate) use self::search::search;
use crate::generate::law::{Injection, Nature, Stage};
use crate::generate::requested_fault::RequestedFault;
use std::sync::Arc;
use switchback_identify::free::Model;
use switchback_model::rig::Rig;

/// Sizes below this are reported as not observable: less than half of what the model misses anyway.
pub const OBSERVABLE: f64 = 0.5;

/// A fault as it was planted.
#[derive(Debug, Clone, PartialEq)]
pub struct InjectedFault {
    /// Its name.
    pub effect: &'static str,
    /// Its law.
    pub law: &'static str,
    /// Where it acts.
    pub stage: Stage,
    /// Whether it moves the expected output.
    pub nature: Nature,
    /// How it came into the records.
    pub injection: Injection,
    /// Magnitude, in `unit`.
    pub magnitude: f64,
    /// What magnitude 1 means.
    pub unit: &'static str,
    /// What the magnitude is, where its unit does not say it.
    pub quantity: Option<&'static str>,
    /// Size that was asked for.
    pub wanted: f64,
    /// What survives identification anew.
    pub size: f64,
    /// What a model given beforehand newly misses.
    pub raw: f64,
    /// Root mean square of what the base's model leaves on the judged records, output units.
    pub residual: f64,
}

impl InjectedFault {
    /// Whether it is large enough to be asked for.
    pub fn is_observable(&self) -> bool {
        self.size >= OBSERVABLE
    }
}

/// A rig with a fault, and what it is.
#[derive(Debug)]
pub struct InjectedRig {
    /// The records.
    pub rig: Rig,
    /// What is withheld.
    pub fault: InjectedFault,
}

/// Records with the model that was identified from them, ready for faults.
#[derive(Debug)]
pub struct InjectionContext<'a> {
    rig: &'a Rig,
    base: Base,
    host_model: Arc<HostModel>,
}

impl<'a> InjectionContext<'a> {
    /// Identifies what is needed of a rig.
    ///
    /// # Errors
    /// [`InjectionError`] where the records give no model with a loop, or one that misses nothing.
    pub fn new(rig: &'a Rig) -> Result<Self, InjectionError> {
        let base = Base::new(rig)?;
        let host_model = HostModel::identified(rig, &base)?;
        Ok(Self { rig, base, host_model: Arc::new(host_model) })
    }

    /// The same with a model of one's own to carry what has to be carried.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn carried_by(rig: &'a Rig, model: &Model) -> Result<Self, InjectionError> {
        Ok(Self { rig, base: Base::new(rig)?, host_model: Arc::new(HostModel::of(rig, model)?) })
    }

    /// The ground that other records of the same machine are, the same inputs with other noise: sizes are measured against a model identified
    /// anew from these, of the order, delay and knots chosen before; the host model stays.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub(crate) fn with_records<'b>(&self, rig: &'b Rig) -> Result<InjectionContext<'b>, InjectionError> {
        Ok(InjectionContext { rig, base: self.base.of_other(rig)?, host_model: Arc::clone(&self.host_model) })
    }

    /// Plants a fault of a size; everything random about it is drawn from the seed.
    ///
    /// # Errors
    /// [`InjectionError::Record`] where the altered signals are not finite.
    pub fn inject(&self, requested_fault: &RequestedFault, seed: u64) -> Result<InjectedRig, InjectionError> {
        self.inject_to(Precision::FINE, requested_fault, seed)
    }

    /// The same with the size met as closely as asked.
    ///
    /// # Errors
    /// As [`Self::machine`].
    pub(crate) fn inject_to(
        &self,
        precision: Precision,
        requested_fault: &RequestedFault,
        seed: u64,
    ) -> Result<InjectedRig, InjectionError> {
        let law = requested_fault.law;
        let with = |magnitude: f64| self.again(requested_fault, magnitude, seed);
        let goal = Goal { size: requested_fault.size, limit: law.limit(), precision };
        let Trial { magnitude, size, rig } = search(&self.base, goal, with)?;
        let fault = InjectedFault {
            effect: law.effect(),
            law: law.name(),
            stage: law.stage(),
            nature: law.nature(),
            injection: law.injection(),
            magnitude,
            unit: law.unit(),
            quantity: law.quantity(),
            wanted: requested_fault.size,
            size,
            raw: self.base.raw(&rig),
            residual: self.base.residual,
        };
        Ok(InjectedRig { rig, fault })
    }
}

#[cfg(test)]
mod tests;
