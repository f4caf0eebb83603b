//! The sim-to-real gap of a switched-hysteresis model.

mod acting;
mod assembly;
mod attribution;
mod beginnings;
mod borders;
mod campaign;
mod closure;
mod clustering;
mod decide;
mod dense_sums;
mod design;
mod diagnose;
mod diagnosis;
mod dynamics;
mod effect;
mod effects;
mod engine;
mod error;
mod experiments;
mod explain;
mod forwards;
mod gains;
mod given;
mod jacobian;
mod knots;
mod lattice;
mod linear;
mod localise;
mod mask;
mod mixed_sums;
mod motion;
mod noise_response;
mod noise_size;
mod nominal;
mod normal;
mod odds;
mod omnibus;
mod order;
mod pairs;
mod repeats;
mod rows;
mod score;
mod search;
mod sensor;
mod settings;
mod simulate;
mod simulators;
mod spectral;
mod spectrum;
mod starts;
mod sums;
mod weights;
mod whitener;
pub mod workbench;
mod workers;

pub use diagnose::{diagnose, diagnose_with};
pub use diagnosis::{
    Candidate, Cell, Diagnosis, ExperimentKind, Figure, FittedParameter, Gap, HoldoutSeries, NextExperiment,
    RecordGap, ResidualPicture, Status, Together, Verdict,
};
pub use effect::{Effect, Stage};
pub use error::DiagnoseError;
pub use settings::{Model, NominalModel, Settings};
pub use workers::{Serial, Workers};
#[cfg(test)]
mod testing;
