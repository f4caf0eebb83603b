//! The noise of a study: unit white normals in lanes, and the one pass over them that serves every cell.
//!
//! One stream of ChaCha8 a replicate ([`StreamId`]), one replicate a SIMD lane ([`Width`]), normals by Box
//! and Muller's transform without a branch ([`WhiteNoise`]). [`NoisePass`] filters them by C/A and keeps, at
//! each checkpoint, what the estimators need: lag products, folds and edges ([`NoiseRecord`]). Where they need
//! the mean only, [`MeanNoise`] draws it from its law. [`samples`] gives the same noise in the open.

mod aligned;
mod chacha;
mod kernels;
mod lane_records;
pub mod lanes;
mod means;
mod normal;
#[cfg(test)]
mod oracle;
mod pass;
mod plan;
mod record;
mod samples;
#[cfg(test)]
mod tests;
mod white;
mod width;

pub use lane_records::LaneRecords;
pub use lane_records::LaneView;
pub use means::MeanNoise;
#[cfg(test)]
pub(crate) use oracle::record_by_definition;
pub use pass::NoisePass;
pub use plan::NoisePlan;
#[cfg(test)]
pub(crate) use plan::NoisePlanError;
pub use record::Checkpoint;
pub use record::NoiseRecord;
pub use samples::NoiseSamples;
pub use samples::samples;
pub use samples::white_samples;
pub use white::BLOCK;
pub use white::StreamId;
pub use white::WhiteNoise;
pub use width::Width;
