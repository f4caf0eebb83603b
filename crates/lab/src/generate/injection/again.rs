//! What was found once, without searching for it again.

use super::alter::altered;
use super::{InjectionContext, InjectionError};
use crate::generate::law::Amount;
use crate::generate::requested_fault::RequestedFault;
use crate::generate::simulate::Active;
use crate::generate::stream::{Purpose, stream};
use rand::RngExt;
use switchback_identify::free::{Identified, Model};
use switchback_model::rig::Rig;

impl InjectionContext<'_> {
    /// The model that sizes are measured against: identified from the fit records as they are.
    pub(crate) fn identified(&self) -> &Identified {
        &self.base.identified
    }

    /// The model that carries faults.
    pub(crate) fn host(&self) -> &Model {
        &self.host_model.model
    }

    /// The records with a fault whose magnitude is known: with that of [`machine`](Self::machine) and the same seed the same records to the bit.
    ///
    /// # Errors
    /// [`InjectionError::Record`] where the altered signals are not finite.
    pub(crate) fn again(
        &self,
        requested_fault: &RequestedFault,
        magnitude: f64,
        seed: u64,
    ) -> Result<Rig, InjectionError> {
        let mut rng = stream(seed, Purpose::Shape(0));
        let shape = std::array::from_fn(|_| rng.random());
        let active = Active { law: requested_fault.law, amount: Amount { magnitude, shape }, slot: 0 };
        altered(self.rig, &self.host_model, &active, seed)
    }
}
