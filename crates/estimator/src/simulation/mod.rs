//! Simulated records, and the noise in them.

pub mod noise;
