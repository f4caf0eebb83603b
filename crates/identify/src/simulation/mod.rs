//! Simulated experiments, their noise, and the superposition that spares simulating them.

mod design;
mod lanes;
mod periodic;
mod precision;
mod sum_covariance;
mod superposition;

pub use design::PeriodicDesign;
pub use lanes::Grouping;
pub use lanes::LaneCross;
pub use lanes::LaneGroupedNoise;
pub use lanes::LaneMoments;
pub use lanes::LaneSuperposition;
pub use periodic::periodic_response;
pub use precision::PlannedPrecision;
pub use precision::PredictedErrors;
pub use sum_covariance::SumCovariance;
pub use superposition::NoiseMoments;
pub use superposition::superpose;
