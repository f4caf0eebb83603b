//! Methods for the designed experiments, all on sufficient statistics.
//!
//! Every method here is one linear (or, for [`efficient()`], one iterated) least squares over [`GroupedStatistics`] that differs
//! in its columns only; see each method for its own reference.

mod arrow;
mod data;
mod efficient;
mod excitation;
mod experiments;
mod fit;
mod grouped;
mod joint;
mod linear_arx;
mod memoryless;
mod paper;

pub use data::{PulseData, PulseDataError, StepMean};
pub use efficient::efficient;
pub use excitation::excitation;
pub use fit::{Estimated, PulseFit, PulseFitError};
pub use grouped::GroupedStatistics;
pub use joint::joint;
pub use linear_arx::linear_arx;
pub use memoryless::memoryless;
pub use paper::paper;
