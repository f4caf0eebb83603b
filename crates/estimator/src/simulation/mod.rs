//! Simulated experiments, their noise, and the superposition that spares simulating them.

mod design;
mod lanes;
pub mod noise;
mod periodic;
mod superposition;

pub use design::PeriodicDesign;
pub use lanes::{LaneMoments, LaneSuperposition};
pub use periodic::periodic_response;
pub use superposition::{NoiseMoments, superpose};
