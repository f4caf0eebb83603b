//! The memory of the whole second order.

use switchback_noise::lanes::Lane;

/// Memory of a replicate's second order.
#[derive(Debug, Clone, Default)]
pub(super) struct Scratch {
    /// Mean residuals of the groups.
    pub(super) residuals: Vec<Lane>,
    /// What stands against each group in the second order, over its count.
    pub(super) along: Vec<Lane>,
    /// What the shared columns make of the core's change, a row each.
    pub(super) rows: Vec<Lane>,
    /// First and second order of the local columns.
    pub(super) first: Vec<Lane>,
    pub(super) second: Vec<Lane>,
}
