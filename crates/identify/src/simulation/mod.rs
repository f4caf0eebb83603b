//! Simulated experiments, their noise, and the superposition that spares simulating them.

mod design;
mod lanes;
mod periodic;
mod precision;
mod sum_covariance;
mod superposition;

pub use design::PeriodicDesign;
pub use lanes::{Grouping, LaneCross, LaneGroupedNoise, LaneMoments, LaneSuperposition};
pub use periodic::periodic_response;
pub use precision::{PlannedPrecision, PredictedErrors};
pub use sum_covariance::SumCovariance;
pub use superposition::{NoiseMoments, superpose};
