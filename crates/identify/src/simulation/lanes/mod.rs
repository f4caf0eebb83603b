//! Superposition for eight replicates abreast.

mod grouped;
mod moments;
mod superposition;

pub use grouped::Grouping;
pub use grouped::LaneGroupedNoise;
pub use moments::LaneMoments;
pub use superposition::LaneCross;
pub use superposition::LaneSuperposition;
