//! The methods of this module for eight replicates abreast, for Monte-Carlo studies.
//!
//! Everything that does not change from replicate to replicate is worked out once ([`LaneMethod`], [`LaneControl`]); the rest is the
//! algebra of [`super::PulseMethod`] on [`Lane`]s, without allocation. That one by one is the oracle.

mod arrow;
mod columns;
mod constrained;
mod control;
mod factor;
mod fit;
mod folded;
mod levels;
mod method;
mod profile;
mod profile_control;
mod sample;
mod scratch;
mod sized;
mod statistics;
mod step;
mod terms;
mod whole;

pub(crate) use control::FoldControl;
pub use control::LaneControl;
pub use fit::LaneFit;
pub use method::LaneMethod;
pub use sample::LaneSample;
pub use statistics::LaneStatistics;
pub use step::LaneStep;
pub use terms::LaneTerms;

pub use switchback_noise::lanes::LANES;
pub use switchback_noise::lanes::Lane;
