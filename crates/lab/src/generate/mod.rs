//! Rigs made with a chosen effect, so that a diagnosis of the sim-to-real gap can be tried on a withheld truth.
//!
//! A made rig is a random nominal system (order, poles, borders, interval, units and noise all drawn from one
//! seed), a dataset of records as a user would take them, and at most a few *effects* that the nominal model lacks.
//! An effect has one or more *laws*: the first is the plain textbook one, the others are what physics offers
//! besides (Bouc–Wen, Dahl, Maxwell slip, Preisach, LuGre, other envelopes, other noises). Some effects are in
//! no library of causes at all; they serve to try whether a diagnosis can say "none of these".
//!
//! A rig stands in the laboratory or, by [`MakeRig::setting`], in the [field](Setting::Field): nothing is declared, no experiment is
//! designed, the noise has a colour, and the machine has by itself what no simple model has. Sizes of effects are measured against that.
//!
//! The crate knows nothing of the candidates that explain a gap: it shares no law with them. It is pure: no files,
//! clocks, threads or ambient randomness.
//!
//! ```
//! use switchback_lab::generate::{RequestedFault, MakeRig};
//!
//! let made = MakeRig::new(7).with(RequestedFault::plain("backlash", 2.0)?).make()?;
//! assert_eq!(made.rig.records.len(), 7);
//! assert!((made.key.effects[0].size - 2.0).abs() < 0.1);
//! # Ok::<(), switchback_lab::generate::MakeError>(())
//! ```

pub(crate) mod dataset;
pub(crate) mod effects;
pub(crate) mod field;
pub(crate) mod generator;
pub(crate) mod injection;
mod key;
pub(crate) mod law;
pub(crate) mod machine;
mod made_rig;
mod make;
mod make_error;
mod recipe_error;
mod refit;
mod requested_fault;
mod setting;
pub(crate) mod simulate;
mod size;
pub(crate) mod stream;

pub use dataset::Passage;
pub use dataset::Plan;
pub use effects::EFFECTS;
pub use effects::FOREIGN;
pub use effects::FURTHER_FOREIGN;
pub use effects::UNNAMED;
pub use effects::laws_of;
pub use injection::InjectedFault;
pub use injection::InjectedRig;
pub use injection::InjectionContext;
pub use injection::InjectionError;
pub use injection::OBSERVABLE;
pub use injection::Precision;
pub use key::Key;
pub use key::TrueEffect;
pub(crate) use key::Truth;
pub(crate) use law::INTERVAL_WIDTHS;
pub use law::Nature;
#[cfg(test)]
pub(crate) use law::{Injection, Stage};
pub use machine::Family;
pub use machine::Machine;
pub use machine::Shape;
pub use made_rig::MadeRig;
pub use make::MakeRig;
pub use make_error::MakeError;
pub use recipe_error::RecipeError;
pub use requested_fault::RequestedFault;
pub use setting::Setting;
