//! Designed experiments: what to drive the input with.
//!
//! Every record begins with one *loading* sample at the end of the interval opposite the satellite: `u` before the
//! first move of `v` is unknown, and the move from there to the satellite puts the working point on a known border.

mod dataset;
mod direction;
mod error;
mod free;
mod levels;
mod pulse;
mod reversals;
mod step;

pub use dataset::Dataset;
pub use dataset::PlannedRecord;
pub use direction::Direction;
pub use error::ExcitationError;
pub use free::RandomLevels;
pub use pulse::PulseExperiment;
pub use reversals::Reversals;
pub use step::StepExperiment;
