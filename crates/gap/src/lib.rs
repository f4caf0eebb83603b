//! The sim-to-real gap of a switched-hysteresis model.

mod diagnosis;
mod effect;
mod error;
mod settings;

pub use diagnosis::{
    Candidate, Cell, Diagnosis, ExperimentKind, Figure, FittedParameter, Gap, HoldoutSeries, NextExperiment,
    RecordGap, ResidualPicture, Status, Verdict,
};
pub use effect::{Effect, Stage};
pub use error::DiagnoseError;
pub use settings::{Model, NominalModel, Settings};
