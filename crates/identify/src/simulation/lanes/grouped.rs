//! The noise of eight replicates, sorted into the groups of a design.

use super::moments::LaneMoments;
use crate::simulation::PeriodicDesign;
use crate::simulation::superposition::visits;
use switchback_noise::lanes::{Lane, Work, keep_apart, widest};

/// Which groups the phases of a design feed over so many samples: the same for every border and noise level.
#[derive(Debug, Clone, PartialEq)]
pub struct Grouping {
    /// `n + 1`.
    pub(super) width: usize,
    /// The group of each phase.
    pub(super) groups: Vec<usize>,
    /// `K_q`.
    pub(super) counts: Vec<f64>,
    /// `1/K_q`, zero for a group without samples.
    shares: Vec<f64>,
    /// Phases that share their group with others.
    pub(super) crowded: Vec<usize>,
    /// `1/K_p`, zero for a phase without samples.
    phase_shares: Vec<f64>,
}

impl Grouping {
    /// The grouping of a design over `samples` samples.
    pub fn new(design: &PeriodicDesign, samples: usize) -> Self {
        let period = design.period();
        let mut counts = vec![0.0; design.group_count()];
        let mut phases = vec![0; counts.len()];
        let share = |count: f64| if count > 0.0 { 1.0 / count } else { 0.0 };
        let mut phase_shares = Vec::with_capacity(period);
        for (p, &q) in design.groups.iter().enumerate() {
            let count = visits(samples, period, p) as f64;
            phase_shares.push(share(count));
            counts[q] += count;
            phases[q] += 1;
        }
        Self {
            phase_shares,
            width: design.order + 1,
            groups: design.groups.clone(),
            shares: counts.iter().map(|&count| share(count)).collect(),
            counts,
            crowded: (0..period).filter(|&p| phases[design.groups[p]] > 1).collect(),
        }
    }
}

/// What the noise of eight replicates contributes to the statistics of a design, whatever its borders.
///
/// ```text
/// ē_q,l = Σ_{p∈q} G_p,l / K_q                            group means
/// V_i,l = Σ_t e(t−i)e(t−l) − Σ_q K_q ē_q,i ē_q,l         within the groups
/// G_p,l                                                  where the response may differ from its group's mean
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct LaneGroupedNoise {
    /// `ē`, `Q × (n+1)`, rows first.
    pub(super) means: Vec<Lane>,
    /// `V`, the lower triangle of `(n+1) × (n+1)`.
    pub(super) within: Vec<Lane>,
    /// `G` of the crowded phases, rows first.
    pub(super) crowded: Vec<Lane>,
    /// `G_p,0/K_p` of every phase, where what the folds leave is asked for.
    pub(super) folds: Vec<Lane>,
    /// What the folds leave, lag by lag.
    pub(super) left: Vec<Lane>,
}

impl LaneGroupedNoise {
    /// Sorts the noise of eight replicates.
    ///
    /// # Panics
    /// If the moments are of another order or period.
    pub fn new(grouping: &Grouping, moments: &LaneMoments) -> Self {
        let width = grouping.width;
        assert_eq!(
            (moments.folds.len(), moments.products.len()),
            (grouping.groups.len() * width, width * width),
            "noise and design have one order and period"
        );
        let mut noise = Self {
            means: vec![Lane::ZERO; grouping.counts.len() * width],
            within: moments.products.clone(),
            crowded: Vec::with_capacity(grouping.crowded.len() * width),
            folds: Vec::new(),
            left: moments.left.clone(),
        };
        if !moments.left.is_empty() {
            let folds = moments.folds.iter().step_by(width).zip(&grouping.phase_shares);
            noise.folds.extend(folds.map(|(fold, share)| *fold * *share));
        }
        for p in &grouping.crowded {
            noise.crowded.extend_from_slice(&moments.folds[p * width..(p + 1) * width]);
        }
        widest(Sort { noise: &mut noise, grouping, moments });
        noise
    }
}

/// [`LaneGroupedNoise::new`] on its way.
struct Sort<'a> {
    noise: &'a mut LaneGroupedNoise,
    grouping: &'a Grouping,
    moments: &'a LaneMoments,
}

impl Work for Sort<'_> {
    #[inline(always)]
    fn run(self) {
        let Self { noise, grouping, moments } = self;
        // Loops of a known length unroll.
        match grouping.width {
            2 => noise.sort(grouping, moments, 2),
            3 => noise.sort(grouping, moments, 3),
            4 => noise.sort(grouping, moments, 4),
            5 => noise.sort(grouping, moments, 5),
            width => noise.sort(grouping, moments, width),
        }
    }
}

impl LaneGroupedNoise {
    #[inline(always)]
    fn sort(&mut self, grouping: &Grouping, moments: &LaneMoments, width: usize) {
        for (fold, &q) in moments.folds.chunks_exact(width).zip(&grouping.groups) {
            keep_apart();
            let sums = &mut self.means[q * width..(q + 1) * width];
            for l in 0..width {
                sums[l] += fold[l];
            }
        }
        let within = &mut self.within[..width * width];
        for (mean, &share) in self.means.chunks_exact_mut(width).zip(&grouping.shares) {
            keep_apart();
            for i in 0..width {
                let sum = mean[i];
                mean[i] = sum * share;
                for l in 0..=i {
                    within[i * width + l] -= sum * mean[l];
                }
            }
        }
    }
}
