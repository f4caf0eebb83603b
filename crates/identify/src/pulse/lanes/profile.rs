//! The profile score of eight replicates less their score.

use super::statistics::LaneStatistics;
use crate::pulse::arrow::{ArrowFit, Columns};
use std::ops::Range;
use switchback_noise::lanes::{Lane, keep_apart};

/// The local columns as the [profile score](crate::pulse::Limit) needs them.
#[derive(Debug, Clone, Default)]
pub(crate) struct ProfilePlan {
    /// Whether each group has a local column to itself.
    pub(super) alone: Vec<bool>,
    /// The other local columns.
    columns: Vec<Tied>,
    /// Their groups and weights, one after the other.
    support: Vec<(usize, f64)>,
    bilinear: bool,
}

/// A local column over several groups.
#[derive(Debug, Clone)]
struct Tied {
    /// Its entries of [`ProfilePlan::support`].
    entries: Range<usize>,
    /// `c/D` of the limit on `a`.
    slope: Vec<f64>,
}

impl ProfilePlan {
    pub(crate) fn of(fit: &ArrowFit, columns: &Columns, order: usize) -> Self {
        let mut plan = Self {
            alone: vec![false; columns.offset.len()],
            columns: Vec::new(),
            support: Vec::new(),
            bilinear: columns.bilinear,
        };
        for (column, tie) in columns.local.iter().zip(&fit.ties) {
            // A column of one group is that group's mean whatever its weight, and has nothing to say of a level's lags.
            if let &[(group, _)] = column.support.as_slice() {
                plan.alone[group] = true;
            } else {
                let first = plan.support.len();
                plan.support.extend(&column.support);
                let slope = tie.slope.iter().take(order).copied().collect();
                plan.columns.push(Tied { entries: first..plan.support.len(), slope });
            }
        }
        plan
    }

    /// Adds what the columns of several groups make, given the residual sums.
    #[inline(always)]
    pub(super) fn add_tied<const N: usize, const D: usize>(
        &self,
        parts: &[&LaneStatistics],
        residuals: &[Lane],
        reference: Lane,
        shift: &mut [Lane; D],
    ) {
        let first = parts[0].counts.len();
        for column in &self.columns {
            keep_apart();
            let support = &self.support[column.entries.clone()];
            let (mut own, mut target, mut cross) = (0.0, Lane::ZERO, [Lane::ZERO; N]);
            for &(group, w) in support {
                keep_apart();
                let (part, q) = if group < first { (parts[0], group) } else { (parts[1], group - first) };
                let weight = w * part.counts[q];
                own += w * weight;
                target += residuals[group] * w;
                let mean = &part.means[q * (N + 1)..(q + 1) * (N + 1)];
                for i in 0..N {
                    cross[i] += (mean[i + 1] - reference) * weight;
                }
            }
            let change = target * (1.0 / own);
            for i in 0..N {
                shift[i] += cross[i] * change + target * column.slope[i];
            }
            if self.bilinear {
                for (i, &(group, w)) in support.iter().enumerate() {
                    keep_apart();
                    let count =
                        if group < first { parts[0].counts[group] } else { parts[1].counts[group - first] };
                    shift[N + i] += change * (residuals[group] - change * (w * count));
                }
            }
        }
    }
}
