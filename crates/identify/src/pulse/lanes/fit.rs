//! The estimates of eight replicates.

use super::arrow::Locals;
use super::columns::ColumnValues;
use super::folded::work::FoldWork;
use switchback_noise::lanes::{LANES, Lane};

/// Estimates of eight replicates with their variances; memory that is used again and again.
#[derive(Debug, Clone, Default)]
pub struct LaneFit {
    /// `a`, `b`, then the border points: the order of [`super::super::PulseFit::parameters`].
    pub values: Vec<Lane>,
    /// Their variances: the squares of the standard errors.
    pub variances: Vec<Lane>,
    /// Whether the replicate has an estimate; if not, ask [`PulseMethod::fit`](crate::pulse::PulseMethod::fit) why.
    pub sound: [bool; LANES],
    pub(super) locals: Locals,
    pub(super) linearised: ColumnValues,
    pub(super) folded: FoldWork,
}

impl LaneFit {
    /// Zero where value and variance are numbers: zero times anything else is not.
    #[inline(always)]
    pub(super) fn spoilt(value: Lane, variance: Lane) -> Lane {
        (value + variance) * 0.0
    }

    /// Leaves the replicates where the sum of [`Self::spoilt`] is not zero to the solver that goes one by one.
    #[inline(always)]
    pub(super) fn leave_out(&mut self, spoilt: Lane) {
        for l in 0..LANES {
            self.sound[l] &= spoilt.0[l] == 0.0;
        }
    }
}
