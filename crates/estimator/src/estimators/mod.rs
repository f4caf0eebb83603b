//! Estimators: from a record to a system.

mod estimate;

pub use estimate::{BorderPoint, Estimate};
