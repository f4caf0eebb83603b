//! Rigs of the field: known faults in measured records and in made ones as the field has them.
//!
//! A *base* is a measured rig from a folder, or a made one. Every rig of the design is a base with a fault, a foreign fault, resampled
//! residuals, or nothing; it is diagnosed twice, once with the base's own model given ("what has changed?") and once without. What a measured
//! base shows by itself is unlabelled: an answer is judged by what it names beyond the base's own verdict, so that silence is silence and
//! nothing that the machine has anyway counts as an error.

mod bases;
mod fault;
mod key;
mod made;
mod measure;
mod resample;
mod rigs;
mod score;
mod tables;

pub use bases::Bases;
pub use bases::measured_rigs;
pub(crate) use key::Key;
pub(crate) use measure::targets;
pub(crate) use resample::resampled;
pub(crate) use resample::runs_of;
pub(crate) use rigs::Rigs;
pub(crate) use score::score;
pub(crate) use tables::bins;
