//! Eight replicates as a method sees them.

use super::statistics::LaneStatistics;
use super::step::LaneStep;

/// Eight replicates as a method sees them.
#[derive(Debug, Clone, Copy)]
pub struct LaneSample<'a> {
    /// The statistics of the method's experiments, in their order.
    pub parts: &'a [&'a LaneStatistics],
    /// The step experiment, for the paper's methods.
    pub step: Option<LaneStep>,
}
