//! Files: rigs, models, results, and folders that are replaced whole.

pub mod diagnosis;
pub mod export;
pub mod identification;
pub mod input;
pub mod model;
pub mod output;
pub mod platform;
pub mod progress;
pub mod provenance;
pub mod rig;
pub mod threads;
pub mod values;

/// The page of a folder of results.
pub const INDEX: &str = "index.html";
