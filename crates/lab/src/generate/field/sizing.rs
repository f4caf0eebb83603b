//! How large an effect in a machine of the field is.

use crate::generate::ingredient::Ingredient;
use crate::generate::key::TrueEffect;
use crate::generate::make_error::MakeError;
use crate::generate::planting::{Base, Goal, PlantingError, Precision, search};
use crate::generate::simulate::Active;
use crate::generate::workshop::Workshop;

/// Finds the magnitude of each effect, alone in the machine.
pub(crate) fn sized(
    workshop: &Workshop,
    ingredients: &[Ingredient],
) -> Result<(Vec<Active>, Vec<TrueEffect>), MakeError> {
    if ingredients.is_empty() {
        return Ok((Vec::new(), Vec::new()));
    }
    let base = base(workshop)?;
    let one = |(slot, ingredient): (usize, &Ingredient)| {
        let law = ingredient.law;
        // What counts noise sds has no limit of its own; slow poles make the same equation noise larger in the output.
        let larger = if law.counts_noise() { workshop.plant.noise_amplification().max(1.0) } else { 1.0 };
        let with = |magnitude: f64| Ok(workshop.rig(&[workshop.active(slot, law, magnitude)])?);
        let limit = larger * law.limit();
        let goal = Goal { size: ingredient.size, limit, precision: Precision::FINE };
        let found = search(&base, goal, with).map_err(refused)?;
        let entry = ingredient.found(found.magnitude, found.size);
        Ok((workshop.active(slot, law, found.magnitude), entry))
    };
    ingredients.iter().enumerate().map(one).collect()
}

/// Size of all effects together.
pub(crate) fn size_of_all(
    workshop: &Workshop,
    active: &[Active],
    effects: &[TrueEffect],
) -> Result<f64, MakeError> {
    match effects {
        [] => Ok(0.0),
        [one] => Ok(one.size),
        _ => Ok(base(workshop)?.surviving(&workshop.rig(active)?)),
    }
}

fn base(workshop: &Workshop) -> Result<Base, MakeError> {
    Base::new(&workshop.rig(&[])?).map_err(refused)
}

fn refused(error: PlantingError) -> MakeError {
    match error {
        PlantingError::Recipe(error) => error,
        PlantingError::Record(error) => MakeError::Record(error),
        no_model => MakeError::NoSize(no_model.to_string()),
    }
}
