//! How large an effect in a machine of the field is.

use crate::generate::generator::Generator;
use crate::generate::injection::{Base, Goal, InjectionError, Precision, search};
use crate::generate::key::TrueEffect;
use crate::generate::make_error::MakeError;
use crate::generate::requested_fault::RequestedFault;
use crate::generate::simulate::Active;

/// Finds the magnitude of each effect, alone in the machine.
pub(crate) fn sized(
    generator: &Generator,
    requested_faults: &[RequestedFault],
) -> Result<(Vec<Active>, Vec<TrueEffect>), MakeError> {
    if requested_faults.is_empty() {
        return Ok((Vec::new(), Vec::new()));
    }
    let base = base(generator)?;
    let one = |(slot, requested_fault): (usize, &RequestedFault)| {
        let law = requested_fault.law;
        // What counts noise sds has no limit of its own; slow poles make the same equation noise larger in the output.
        let larger = if law.counts_noise() { generator.machine.noise_amplification().max(1.0) } else { 1.0 };
        let with = |magnitude: f64| Ok(generator.rig(&[generator.active(slot, law, magnitude)])?);
        let limit = larger * law.limit();
        let goal = Goal { size: requested_fault.size, limit, precision: Precision::FINE };
        let found = search(&base, goal, with).map_err(refused)?;
        let entry = requested_fault.found(found.magnitude, found.size);
        Ok((generator.active(slot, law, found.magnitude), entry))
    };
    requested_faults.iter().enumerate().map(one).collect()
}

/// Size of all effects together.
pub(crate) fn size_of_all(
    generator: &Generator,
    active: &[Active],
    effects: &[TrueEffect],
) -> Result<f64, MakeError> {
    match effects {
        [] => Ok(0.0),
        [one] => Ok(one.size),
        _ => Ok(base(generator)?.surviving(&generator.rig(active)?)),
    }
}

fn base(generator: &Generator) -> Result<Base, MakeError> {
    Base::new(&generator.rig(&[])?).map_err(refused)
}

fn refused(error: InjectionError) -> MakeError {
    match error {
        InjectionError::Recipe(error) => error,
        InjectionError::Record(error) => MakeError::Record(error),
        no_model => MakeError::NoSize(no_model.to_string()),
    }
}
