//! The leading terms of the errors of eight replicates.

use super::scratch::Scratch;
use switchback_noise::lanes::Lane;

/// The leading terms of the errors of eight replicates; memory that is used again and again.
#[derive(Debug, Clone, Default)]
pub struct LaneTerms {
    /// First order, one a parameter.
    pub first: Vec<Lane>,
    /// The second, or what the profile score holds of it.
    pub second: Vec<Lane>,
    pub(super) residuals: Vec<Lane>,
    pub(super) whole: Scratch,
}
