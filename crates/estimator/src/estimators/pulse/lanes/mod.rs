//! The methods of this module for eight replicates abreast, for Monte-Carlo studies.
//!
//! Everything that does not change from replicate to replicate is worked out once ([`LaneMethod`], [`LaneControl`]); the rest is the
//! algebra of [`super::PulseMethod`] on [`Lane`]s, without allocation. That one by one is the oracle.

mod arrow;
mod constrained;
mod control;
mod lane;
mod levels;
mod method;
mod statistics;
mod wide;

pub use control::LaneControl;
pub use lane::{LANES, Lane};
pub use method::{LaneFit, LaneMethod, LaneStep};
pub use statistics::LaneStatistics;
