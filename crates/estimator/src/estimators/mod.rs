//! Estimators: from a record to a system.

mod border_distance;
mod estimate;
pub mod free;
mod plus_minus;
pub mod pulse;

pub use border_distance::{BorderDistance, BorderGap};
pub use estimate::{BorderPoint, Coefficient, Estimate, LevelErrors};
pub use plus_minus::PlusMinus;
