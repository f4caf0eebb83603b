//! The memory of a fit on the folds.

use switchback_noise::lanes::Lane;

/// Memory of the Gauss–Newton steps, for use again and again.
#[derive(Debug, Clone, Default)]
pub(in super::super) struct FoldWork {
    pub(super) colour: Vec<Lane>,
    pub(super) mirrored: Vec<Lane>,
    /// `2K/(T S v⁻¹)` of each line, or half of it where it is its own mirror image.
    pub(super) weights: Vec<Lane>,
    /// `Ȳ_k`, experiment by experiment.
    pub(super) outputs: Vec<[Lane; 2]>,
    /// `P H*` times `α`, `β` and the residual of each line, experiment by experiment.
    pub(super) crosses: Vec<[[Lane; 2]; 3]>,
    /// `w` of every level, experiment by experiment.
    pub(super) levels: Vec<Lane>,
    pub(super) gaps: Vec<Lane>,
    /// The factor of what the levels have in common, the inverse pivots on the diagonal.
    pub(super) factor: Vec<Lane>,
    /// What each level has in common with the core and with the residual, `D + 1` a level.
    pub(super) rows: Vec<Lane>,
    /// The column of an inverse.
    pub(super) column: Vec<Lane>,
}
