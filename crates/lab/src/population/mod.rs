//! The population that a posterior is trained on: rigs by the ten thousand, each with its truth beside it.
//!
//! A rig is drawn from a seed and its number alone ([`draw`]): a [family](Family), a machine with records and the errors that it has by
//! itself, and a cause of a wanted size. Sizes are measured after identification anew, to first order, so that nothing has to be identified
//! while a rig is drawn. Laws, machines and faults are those of [`generate`](crate::generate).

mod borders;
mod cause;
mod draw;
mod drive;
mod evidence;
mod family;
mod made;
mod measured;
mod model_error;
mod noise;
mod pairs;
mod parts;
mod random;
mod reidentification;
mod setup;
mod summary;
mod training_rig;

pub use draw::{draw, draw_given};
pub use evidence::{EvidenceRow, evidence_table};
pub use family::Family;
pub use measured::MeasuredBases;
pub use pairs::{Difference, PairTruth, Row, Side, TrainingPair, draw_pair};
pub use summary::pair_summary;
pub use summary::summary;
pub use training_rig::Kind;
pub use training_rig::TrainingRig;
pub use training_rig::TrainingTruth;

#[cfg(test)]
mod tests;
