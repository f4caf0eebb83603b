//! Estimators: from a record to a system.

mod estimate;
pub mod pulse;

pub use estimate::{BorderPoint, Estimate};
