//! Simulated experiments, and the superposition that spares simulating them.

mod design;
mod periodic;
mod superposition;

pub use design::PeriodicDesign;
pub use periodic::periodic_response;
pub use superposition::{NoiseMoments, superpose};
