//! Superposition for eight replicates abreast.

mod moments;
mod superposition;

pub use moments::LaneMoments;
pub use superposition::LaneSuperposition;
