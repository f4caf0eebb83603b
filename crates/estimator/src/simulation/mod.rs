//! Simulated experiments, their noise, and the superposition that spares simulating them.

mod design;
pub mod noise;
mod periodic;
mod superposition;

pub use design::PeriodicDesign;
pub use periodic::periodic_response;
pub use superposition::{NoiseMoments, superpose};
