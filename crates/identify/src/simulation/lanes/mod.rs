//! Superposition for eight replicates abreast.

mod grouped;
mod moments;
mod superposition;

pub use grouped::{Grouping, LaneGroupedNoise};
pub use moments::LaneMoments;
pub use superposition::{LaneCross, LaneSuperposition};
