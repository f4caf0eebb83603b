//! What was found once, without searching for it again.

use super::alter::altered;
use super::{PlantingError, PlantingGround};
use crate::generate::ingredient::Ingredient;
use crate::generate::law::Dose;
use crate::generate::simulate::Active;
use crate::generate::stream::{Purpose, stream};
use rand::RngExt;
use switchback_identify::free::Identified;
use switchback_model::rig::Rig;

impl PlantingGround<'_> {
    /// The model that sizes are measured against: identified from the fit records as they are.
    pub(crate) fn identified(&self) -> &Identified {
        &self.base.identified
    }

    /// The records with a fault whose magnitude is known: with that of [`plant`](Self::plant) and the same seed the same records to the bit.
    ///
    /// # Errors
    /// [`PlantingError::Record`] where the altered signals are not finite.
    pub(crate) fn again(
        &self,
        ingredient: &Ingredient,
        magnitude: f64,
        seed: u64,
    ) -> Result<Rig, PlantingError> {
        let mut rng = stream(seed, Purpose::Shape(0));
        let shape = std::array::from_fn(|_| rng.random());
        let active = Active { law: ingredient.law, dose: Dose { magnitude, shape }, slot: 0 };
        altered(self.rig, &self.carrier, &active, seed)
    }
}
