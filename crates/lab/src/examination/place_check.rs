//! Cells of an axis, flagged and true.

use serde::{Deserialize, Serialize};

/// Cells of one axis, flagged and true.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PlaceCheck {
    /// The axis.
    pub axis: &'static str,
    /// Flagged, and the effect acts there.
    pub hits: usize,
    /// Flagged, but it does not.
    pub false_flags: usize,
    /// Not flagged, but it does.
    pub misses: usize,
}
