//! Sufficient statistics of eight replicates, split into within and between groups.

use crate::pulse::{Folds, GroupedStatistics};
use switchback_noise::lanes::Lane;

/// The statistics of [`GroupedStatistics`] of eight replicates, as means and what is left about them:
///
/// ```text
/// m_q,l = S_q,l / K_q                       group means,       Q × (n+1), rows first
/// W_i,l = P_i,l − Σ_q K_q m_q,i m_q,l       within the groups, (n+1) × (n+1)
/// ```
///
/// A group with a mean of its own (most, in a pulse experiment) adds nothing to the normal equations of `a` but its share of `W`, and of a
/// noise-free response that is constant within the group nothing is left in `W`: there is no cancellation of large sums. The folds are kept for the instrumental method only.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LaneStatistics {
    order: usize,
    /// `K_q`, the same in all replicates.
    pub(crate) counts: Vec<f64>,
    /// `1/K_q`.
    pub(crate) shares: Vec<f64>,
    /// `Σ_q K_q`.
    pub(crate) samples: f64,
    /// `m`.
    pub means: Vec<Lane>,
    /// `W`.
    pub within: Vec<Lane>,
    /// The level that the input visits at each phase, the same in all replicates.
    pub(crate) visits: Vec<Option<usize>>,
    /// The means of [`Folds`], where they are asked for.
    pub folds: Vec<Lane>,
    /// What the folds leave, lag by lag: the products of [`Folds`].
    pub left: Vec<Lane>,
}

impl LaneStatistics {
    /// Makes room for these counts, in the memory at hand; means and products are to be overwritten.
    pub(crate) fn shape(&mut self, order: usize, counts: &[f64], visits: &[Option<usize>]) {
        self.visits.clear();
        self.visits.extend_from_slice(visits);
        let width = order + 1;
        self.order = order;
        self.means.resize(counts.len() * width, Lane::ZERO);
        self.within.resize(width * width, Lane::ZERO);
        self.shares.clear();
        self.shares.extend(counts.iter().map(|count| 1.0 / count));
        self.samples = counts.iter().sum();
        self.counts.clear();
        self.counts.extend_from_slice(counts);
    }

    /// `m_q,0…n`.
    fn mean(&self, group: usize) -> &[Lane] {
        &self.means[group * (self.order + 1)..(group + 1) * (self.order + 1)]
    }

    /// The folds of replicate `lane`, where they were asked for.
    pub fn folds(&self, lane: usize) -> Option<Folds> {
        let of = |lanes: &[Lane]| lanes.iter().map(|x| x.0[lane]).collect::<Vec<_>>();
        (!self.folds.is_empty()).then(|| Folds {
            visits: self.visits.clone(),
            means: of(&self.folds),
            within: of(&self.left),
            samples: self.samples,
        })
    }

    /// Replicate `lane` by itself.
    pub fn replicate(&self, lane: usize) -> GroupedStatistics {
        let width = self.order + 1;
        let mut products: Vec<f64> = self.within.iter().map(|w| w.0[lane]).collect();
        let mut sums = Vec::with_capacity(self.means.len());
        for (q, &count) in self.counts.iter().enumerate() {
            let mean = self.mean(q);
            sums.extend(mean.iter().map(|m| count * m.0[lane]));
            for (k, product) in products.iter_mut().enumerate() {
                *product += count * mean[k / width].0[lane] * mean[k % width].0[lane];
            }
        }
        GroupedStatistics::from_parts(self.order, self.counts.clone(), sums, products)
    }
}
