//! The sim-to-real gap of a switched-hysteresis model: where it lies, which unmodelled effect causes it, how far it closes.
//!
#![doc = include_str!("example.md")]
//!
//! Its private modules, in the order in which a diagnosis passes through them:
//!
//! | module | what it does |
//! |---|---|
//! | `records` | the rig's records in dimensionless form, what moved and what repeats |
//! | `nominal` | the model without effects: identified, of an order chosen, border knots placed; or given |
//! | `effects` | one effect a file: its laws, as additions to the model |
//! | `model` | what is fitted: borders, an augmented model of effects, a sensor's characteristic |
//! | `likelihood` | rows, derivatives, weights and whitening of an augmented model, and its maximum likelihood |
//! | `least_squares` | the normal equations beneath |
//! | `attribution` | effects looked at, fitted, composed: candidates, best first |
//! | `residuals` | tests of what a candidate leaves: in general, by frequency, by parameter |
//! | `simulation` | free runs of what is fitted |
//! | `evidence` | columns of numbers about every effect beside a nominal system without effects |
//! | `differences` | a machine beside another source: values and effects in which both differ, and the `price` of each |
//! | `posterior` | trained weights: probabilities of all outcomes from columns of evidence, and what is reported of them |
//! | `verdict` | odds of the candidates of designed experiments, and what is reported |
//! | `localise`, `closure`, `experiments` | where, how far, and the record that would separate rivals |
//! | `export` | models that leave: all that their free runs depend on, as plain data, with the covariance of what was estimated |
//! | `diagnose`, `diagnosis` | the order of all this, and its report |
//!
//! Its oracle is the crate `switchback-lab`, which makes rigs with known causes and shares no law with this one.

mod attribution;
mod closure;
mod comparison;
mod diagnose;
mod diagnosis;
pub mod differences;
mod effect;
mod effects;
mod error;
pub mod evidence;
mod experiments;
mod export;
mod figure;
mod fitted_parameter;
mod horizon;
mod least_squares;
mod likelihood;
mod localise;
mod model;
mod nominal;
mod nominal_model;
mod phase;
pub mod posterior;
mod records;
mod residuals;
mod settings;
mod simulation;
#[cfg(test)]
mod testing;
mod verdict;
mod workers;

pub use comparison::{Compared, Comparison};
pub use diagnose::{diagnose, diagnose_with};
pub use diagnosis::{
    Candidate, Cell, CellInterval, CellUnit, Diagnosis, ExperimentKind, Gap, HoldoutSeries, NextExperiment,
    ResidualPicture, Together,
};
pub use effect::{Effect, Stage};
pub use error::DiagnoseError;
pub use export::{LooksAhead, PortableModel};
pub use figure::Figure;
pub use fitted_parameter::FittedParameter;
pub use horizon::{Horizon, HorizonGain};
pub use nominal_model::NominalModel;
pub use phase::Phase;
pub use settings::{Model, Settings};
pub use verdict::answer::{Status, Verdict};
#[cfg(test)]
pub(crate) use workers::Serial;
pub use workers::Workers;
