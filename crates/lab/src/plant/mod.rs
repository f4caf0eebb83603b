//! A known fault put into measured records, to try whether a diagnosis finds it.

mod error;
mod json;
mod request;
mod words;

pub use error::PlantError;
pub use json::{json, schema};
pub use request::Request;
pub use words::words;

use crate::generate::{InjectedRig, InjectionContext};
use std::path::Path;
use switchback_identify::free::Model;
use switchback_io::model::{ModelFile, System};
use switchback_model::rig::Rig;

/// The records with the fault. `place` is what messages call the records; the host model is a model and what messages call that.
///
/// # Errors
/// [`PlantError`] for an unknown effect or law, or records or a model that cannot carry it.
pub fn plant(
    rig: &Rig,
    request: &Request,
    (place, host_model): (&Path, Option<(&ModelFile, &Path)>),
) -> Result<InjectedRig, PlantError> {
    let requested_fault = request.requested_fault()?;
    let refused = |error| PlantError::Context { data: name(place), error };
    let context = match host_model {
        Some((file, path)) => InjectionContext::carried_by(rig, carrying(rig, file, path)?),
        None => InjectionContext::new(rig),
    };
    context.and_then(|context| context.inject(&requested_fault, request.seed)).map_err(refused)
}

/// The model of a file, where it can carry a fault into the records of a rig.
fn carrying<'f>(rig: &Rig, file: &'f ModelFile, path: &Path) -> Result<&'f Model, PlantError> {
    file.header.check_units([&rig.input_label, &rig.output_label], (path, "rig"))?;
    let model = name(path);
    if !file.header.runs_at(rig.sample_time) {
        let at = file.header.sample_time;
        return Err(PlantError::SampleTime { model, at, rig: rig.sample_time });
    }
    match &file.system {
        System::Curves(curves) => Ok(curves.model()),
        other @ (System::Switched(_) | System::Machine(_) | System::Points(_)) => {
            Err(PlantError::Model { model, kind: other.kind() })
        }
    }
}

fn name(path: &Path) -> String {
    path.display().to_string()
}
