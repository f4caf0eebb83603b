//! Made bases, as the field has them: nothing is declared.

use super::design::Wanted;
use switchback_estimator::rig::Rig;
use switchback_maker::{Key, MadeRig, MakeError, MakeRig, Plan};

/// The recipe of a made base: short records, as the field has them.
pub(super) fn recipe(seed: u64) -> MakeRig {
    MakeRig::new(seed).plan(Plan { step: 120, periods: 8, sweep: 1500, drive: 800, repeat_periods: 3 })
}

/// A made rig as its user would describe it.
fn undeclared(made: MadeRig) -> Rig {
    Rig { order: None, interval: None, ..made.rig }
}

/// A base without fault, and the effects that the machine has by itself.
pub(super) fn base(seed: u64) -> Result<(Rig, Vec<&'static str>), MakeError> {
    Ok((undeclared(recipe(seed).make()?), Vec::new()))
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
    let made = recipe(seed).with(fault.ingredient()?).make()?;
    found(seed, made)
}

/// The same from what was found: standard deviation of the noise, magnitude and size.
pub(super) fn again(
    seed: u64,
    fault: &Wanted,
    (noise_sd, found_before): (f64, (f64, f64)),
) -> Result<Option<Found>, MakeError> {
    let made = recipe(seed).with(fault.ingredient()?).from_found(noise_sd, &[found_before])?;
    made.map(|made| found(seed, made)).transpose()
}

fn found(seed: u64, made: MadeRig) -> Result<Found, MakeError> {
    let before = recipe(seed).from_found(made.key.noise_sd, &[])?.expect("no effect, no magnitude");
    Ok(Found { key: made.key.clone(), rig: undeclared(made), before: undeclared(before) })
}
