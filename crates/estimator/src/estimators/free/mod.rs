//! Identification from any record: no designed experiment.

mod basis;
mod branch;
mod cross_validation;
mod data;
mod equation_error;
mod error;
mod fit;
mod identify;
mod limit;
mod model;
mod nesting;
mod normalise;
mod one_shot;
mod problem;
mod rank_one;
mod regression;
mod selection;
mod sensor;
mod settings;
mod simulation_error;
mod warning;

pub use basis::Basis;
pub use branch::{Branches, ReversalRule, Timing};
pub use equation_error::Moments;
pub use error::FreeError;
pub use identify::{Identified, identify};
pub use limit::Limit;
pub use model::{FreeRun, Model, fit_percent};
pub use one_shot::{Grid, one_shot};
pub use problem::Structure;
pub use regression::Regression;
pub use selection::{Candidate, Selection};
pub use sensor::SensorNoise;
pub use settings::{InputMap, Settings};
pub use warning::Warning;

#[cfg(test)]
mod tests;
