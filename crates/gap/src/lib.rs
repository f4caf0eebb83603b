//! The sim-to-real gap of a switched-hysteresis model: where it lies, which unmodelled effect causes it, how far it closes.
//!
//! Start at [`diagnose()`]: a rig in, a [`Diagnosis`] out. Behind it, in the order in which a diagnosis passes through them:
//!
//! | room | what it does |
//! |---|---|
//! | `records` | the rig's records in dimensionless form, what moved and what repeats |
//! | `nominal` | the model without effects: identified, of an order chosen, border knots placed; or given |
//! | `effects` | one effect a file: its laws, as additions to the model |
//! | `model` | what is fitted: borders, an assembly of effects, a sensor's characteristic |
//! | `likelihood` | rows, derivatives, weights and whitening of an assembly, and its maximum likelihood |
//! | `least_squares` | the normal equations beneath |
//! | `attribution` | effects looked at, fitted, composed: explanations, best first |
//! | `residuals` | what an explanation leaves: omnibus tests, spectra, scores |
//! | `simulation` | free runs of what is fitted |
//! | `verdict` | calibrated odds of the explanations, and what is told |
//! | `localise`, `closure`, `experiments` | where, how far, and the record that would separate rivals |
//! | `export` | models that leave: all that their free runs depend on, as plain data, with the covariance of what was estimated |
//! | `diagnose`, `diagnosis` | the order of all this, and its report |
//!
//! Its oracle is the crate `switchback-maker`, which makes rigs with known causes and shares no law with this one.

mod attribution;
mod closure;
mod diagnose;
mod diagnosis;
mod effect;
mod effects;
mod error;
mod evidence;
mod experiments;
mod export;
mod least_squares;
mod likelihood;
mod localise;
mod model;
mod nominal;
mod phase;
mod records;
mod residuals;
mod settings;
mod simulation;
#[cfg(test)]
mod testing;
mod verdict;
mod workers;

pub use diagnose::{diagnose, diagnose_with};
pub use diagnosis::{
    Candidate, Cell, CellInterval, CellUnit, Diagnosis, ExperimentKind, Figure, FittedParameter, Gap,
    HoldoutSeries, Horizon, HorizonGain, Models, NextExperiment, RecordGap, Refit, ResidualPicture, Status,
    Together, Verdict,
};
pub use effect::{Effect, Stage};
pub use error::DiagnoseError;
pub use evidence::{Compared, Comparison, EffectEvidence};
pub use export::{LooksAhead, PortableError, PortableModel, Simulated};
pub use phase::Phase;
pub use settings::{Model, NominalModel, Settings};
pub use verdict::fitted;
pub use workers::{Serial, Workers};
