//! Identification from any record: no designed experiment.

mod basis;
mod branch;
mod data;
mod equation_error;
mod error;
mod fit;
mod model;
mod problem;
mod rank_one;
mod settings;
mod simulation_error;

pub use basis::Basis;
pub use branch::{Branches, SensorNoise};
pub use error::FreeError;
pub use model::{FreeRun, Model, fit_percent};
pub use problem::Structure;
pub use settings::{InputMap, Settings};

use crate::record::Record;
use data::Data;

/// EXPERIMENT
pub fn try_fit(records: &[&Record], settings: &Settings) -> Result<Model, FreeError> {
    let data = Data::new(records, settings)?;
    let basis = data.basis(settings.input_map, settings.knots.unwrap_or(7));
    let featured = data.featured(basis);
    let structure = Structure { order: settings.order.unwrap_or(1), delay: settings.delay.unwrap_or(0) };
    let effort = settings.refine.then_some(fit::Effort::FINAL);
    let parameters = fit::fit(&featured, structure, &featured.segments(structure), effort)
        .ok_or(FreeError::Unstable { order: structure.order })?;
    Ok(Model { basis: featured.basis, structure, parameters, threshold: data.threshold })
}
