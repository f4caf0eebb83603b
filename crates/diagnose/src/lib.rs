//! The sim-to-real gap of a switched-hysteresis model: where it lies, which unmodelled effect causes it, how far it closes.
//!
//! A rig in, a [`Diagnosis`] out. From vectors:
//!
//! ```
//! use switchback_model::Record;
//! use switchback_model::rig::{Rig, RigRecord, Role, Usage};
//! use switchback_diagnose::{Effect, Model, Settings, diagnose};
//!
//! // Records: put your own measurements here. This machine has a play of 0.2 before its two borders.
//! let machine = |v: &[f64]| -> Vec<f64> {
//!     let (mut p, mut u, mut y, mut noise) = (v[0], 0.0, 0.0, 1_u64);
//!     let mut step = |v: f64| {
//!         noise = noise.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
//!         y = 0.6 * y + 0.4 * u + 0.02 * ((noise >> 40) as f64 / (1 << 24) as f64 - 0.5);
//!         let moved = p.clamp(v - 0.1, v + 0.1) - p;
//!         p += moved;
//!         u = if moved > 0.0 { p + 0.5 } else if moved < 0.0 { p - 0.5 } else { u };
//!         y
//!     };
//!     v.iter().map(|v| step(*v)).collect()
//! };
//! let record = |name: &str, usage, samples: usize, phase: f64| -> Result<RigRecord, Box<dyn std::error::Error>> {
//!     let drive = |t: f64| 0.55 * (0.17 * t + phase).sin() + 0.45 * (0.025 * t).cos();
//!     let v: Vec<f64> = (0..samples).map(|t| drive(t as f64)).collect();
//!     let y = machine(&v);
//!     Ok(RigRecord { name: name.into(), role: Role::Free, usage, record: Record::new(v, y)?, predicted: None })
//! };
//! let rig = Rig {
//!     name: "bench".into(),
//!     sample_time: 0.01,
//!     order: Some(1),
//!     interval: None,
//!     input_label: "travel [mm]".into(),
//!     output_label: "force [kN]".into(),
//!     records: vec![record("monday", Usage::Fit, 3000, 0.0)?, record("tuesday", Usage::Holdout, 1500, 1.0)?],
//! };
//!
//! // Only two candidates, so that this example takes a moment; `Settings::default()` has all.
//! let settings = Settings { effects: vec![Effect::Backlash, Effect::Creep], ..Settings::default() };
//! let diagnosis = diagnose(&rig, Model::Identify, &settings)?;
//! assert_eq!(diagnosis.verdict.effects, [Effect::Backlash]);
//! assert!(diagnosis.verdict.to_string().starts_with("named: backlash (operator)"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! `examples/diagnose.rs` goes on: it runs the repaired model, [`Diagnosis::models`], on a new input. To give the work to threads, implement
//! [`Workers`] and call [`diagnose_with`]; to follow its progress, see [`Phase`].
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
//! | `verdict` | calibrated odds of the candidates, and what is reported |
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
mod price;
mod records;
mod residuals;
mod settings;
mod simulation;
#[cfg(test)]
mod testing;
mod verdict;
mod workers;

pub use comparison::Compared;
pub use comparison::Comparison;
pub use diagnose::classify;
pub use diagnose::diagnose;
pub use diagnose::diagnose_with;
pub use diagnosis::Candidate;
pub use diagnosis::Cell;
pub use diagnosis::CellInterval;
pub use diagnosis::CellUnit;
pub use diagnosis::Diagnosis;
pub use diagnosis::ExperimentKind;
pub use diagnosis::Gap;
pub use diagnosis::HoldoutSeries;
pub use diagnosis::NextExperiment;
pub use diagnosis::ResidualPicture;
pub use diagnosis::Together;
pub use effect::Effect;
pub use effect::Stage;
pub use error::DiagnoseError;
pub use export::LooksAhead;
pub use export::PortableModel;
pub use figure::Figure;
pub use fitted_parameter::FittedParameter;
pub use horizon::Horizon;
pub use horizon::HorizonGain;
pub use nominal_model::NominalModel;
pub use phase::Phase;
pub use settings::Model;
pub use settings::Settings;
pub use verdict::answer::Status;
pub use verdict::answer::Verdict;
pub use verdict::fitted;
#[cfg(test)]
pub(crate) use workers::Serial;
pub use workers::Workers;
