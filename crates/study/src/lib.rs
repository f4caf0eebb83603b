//! Consistency studies: scenarios, parallel Monte-Carlo execution, checkpoints, verdicts and result tables.

pub mod checkpoint;
pub mod compare;
pub mod consistency;
pub mod design;
pub mod journal;
pub mod parts;
pub mod results;
pub mod scenario;
mod shard;

pub use shard::Shard;
