//! The step experiment of eight replicates.

use switchback_noise::lanes::Lane;

/// Mean of the step experiment's output in each replicate.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LaneStep {
    /// `ŷ₀`.
    pub mean: Lane,
    /// Samples averaged.
    pub samples: f64,
}
