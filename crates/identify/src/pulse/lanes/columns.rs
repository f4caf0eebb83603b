//! The input part of a regression for eight replicates: [`Columns`] in a few flat tables.

use crate::pulse::arrow::Columns;
use std::ops::Range;
use switchback_noise::lanes::Lane;

/// Which groups feed which columns: the same in every replicate and iteration.
#[derive(Debug, Clone)]
pub(super) struct ColumnPlan {
    /// Shared columns `p`.
    pub(super) width: usize,
    /// Groups without a mean of their own, in order: all that the core's normal equations are summed over.
    pub(super) pooled: Vec<usize>,
    /// The local columns.
    pub(super) local: Vec<LocalPlan>,
    /// Groups of the local columns, one column after the other.
    pub(super) support: Vec<usize>,
    /// Whether no shared column touches a group that has its own mean, so that the local columns depend on `a` alone.
    pub(super) apart: bool,
}

/// Where a local column is not zero.
#[derive(Debug, Clone)]
pub(super) struct LocalPlan {
    /// Its entries of [`ColumnPlan::support`] and of [`ColumnValues::weights`].
    pub(super) entries: Range<usize>,
    /// The first of its groups.
    pub(super) group: usize,
    /// Whether it is a group's own mean: then that group drops out of everything else.
    pub(super) own_mean: bool,
}

/// The columns' values.
#[derive(Debug, Clone, Default)]
pub(super) struct ColumnValues {
    /// `x`, `p` a group.
    pub(super) shared: Vec<Lane>,
    /// `o`, one a group.
    pub(super) offset: Vec<Lane>,
    /// Weights of the local columns, in the order of [`ColumnPlan::support`].
    pub(super) weights: Vec<Lane>,
}

impl ColumnPlan {
    /// The plan and the values of columns that are the same in every replicate. A local column of one group is taken as its mean where
    /// `own_means` says so.
    pub(super) fn of(columns: &Columns, own_means: bool) -> (Self, ColumnValues) {
        let splat = |x: &f64| Lane::splat(*x);
        let mut plan = Self {
            width: columns.shared.ncols(),
            pooled: Vec::new(),
            local: Vec::new(),
            support: Vec::new(),
            apart: true,
        };
        let mut saturated = vec![false; columns.offset.len()];
        let mut weights = Vec::new();
        for column in &columns.local {
            let first = plan.support.len();
            plan.support.extend(column.support.iter().map(|(q, _)| *q));
            weights.extend(column.support.iter().map(|(_, w)| splat(w)));
            let own_mean = own_means && column.support.len() == 1;
            if own_mean {
                saturated[column.support[0].0] = true;
            }
            plan.apart &= own_mean && columns.shared.row(column.support[0].0).iter().all(|x| *x == 0.0);
            let group = column.support[0].0;
            plan.local.push(LocalPlan { entries: first..plan.support.len(), group, own_mean });
        }
        plan.pooled = (0..saturated.len()).filter(|q| !saturated[*q]).collect();
        let values = ColumnValues {
            shared: columns.shared.transpose().iter().map(splat).collect(),
            offset: columns.offset.iter().map(splat).collect(),
            weights,
        };
        (plan, values)
    }
}

impl ColumnValues {
    /// Takes over other values of the same plan, in the memory at hand.
    pub(super) fn copy_from(&mut self, other: &Self) {
        self.shared.clone_from(&other.shared);
        self.offset.clone_from(&other.offset);
        self.weights.clone_from(&other.weights);
    }
}
