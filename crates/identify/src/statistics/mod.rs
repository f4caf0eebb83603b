//! Performance measures of estimators, each with its Monte-Carlo standard error, and what residuals say of a model.

mod block_bootstrap;
mod correlation;
mod error_sums;
mod interval_counts;
mod jackknife;
mod lane_errors;
mod line;
mod propagation;
mod quantile;
mod whiteness;

pub use block_bootstrap::MeanInterval;
pub use correlation::correlation;
pub use error_sums::ErrorSums;
pub use error_sums::KnownControl;
pub use error_sums::Performance;
pub use error_sums::ReplicateError;
pub use interval_counts::CLASS_ENDS;
pub use interval_counts::CLASSES;
pub use interval_counts::IntervalCounts;
pub use jackknife::jackknife_se;
pub use lane_errors::LaneErrors;
pub use lane_errors::LaneEstimates;
pub use lane_errors::LaneSums;
pub use line::weighted_line;
pub use propagation::propagated;
pub use quantile::Z95;
pub use quantile::normal_quantile_975;
pub use whiteness::Whiteness;

/// A measured number with its Monte-Carlo standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// The value.
    pub value: f64,
    /// Its Monte-Carlo standard error.
    pub mcse: f64,
}
