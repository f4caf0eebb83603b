//! Made bases, as the field has them.

use crate::examination::wanted::Wanted;
use crate::generate::{Key, MadeRig, MakeError, MakeRig, Setting};
use switchback_model::rig::Rig;

/// The recipe of a made base.
fn recipe(seed: u64) -> MakeRig {
    MakeRig::new(seed).setting(Setting::Field)
}

/// A base without fault, and the effects that the machine has by itself.
pub(super) fn base(seed: u64) -> Result<(Rig, Vec<&'static str>), MakeError> {
    let made = recipe(seed).make()?;
    Ok((made.rig, made.key.base))
}

/// What is known of a fault that the maker put into a machine.
pub(super) struct Found {
    /// Its key.
    pub(super) key: Key,
    /// The rig with the fault.
    pub(super) rig: Rig,
    /// The same machine, inputs and noise without it.
    pub(super) before: Rig,
}

/// The machine of a base with a fault, whose magnitude is searched for.
pub(super) fn with_fault(seed: u64, fault: &Wanted) -> Result<Found, MakeError> {
    let recipe = recipe(seed).with(fault.requested_fault()?);
    let made = recipe.make()?;
    found(recipe, made)
}

/// The same from what was found: standard deviation of the noise, magnitude and size. None where that is of another fault.
pub(super) fn again(
    seed: u64,
    fault: &Wanted,
    (noise_sd, magnitude, size): (f64, f64, f64),
) -> Result<Option<Found>, MakeError> {
    let recipe = recipe(seed).with(fault.requested_fault()?);
    let made = recipe.made_with(noise_sd, &[(magnitude, size)])?;
    made.map(|made| found(recipe, made)).transpose()
}

fn found(recipe: MakeRig, MadeRig { rig, key, .. }: MadeRig) -> Result<Found, MakeError> {
    Ok(Found { key, rig, before: recipe.base().make()?.rig })
}
