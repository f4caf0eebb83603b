//! The statistics of eight replicates at any noise level.

use super::grouped::{Grouping, LaneGroupedNoise};
use crate::pulse::lanes::LaneStatistics;
use crate::simulation::PeriodicDesign;
use crate::simulation::superposition::visits;
use switchback_noise::lanes::{Lane, Work, keep_apart, widest};

/// [`superpose`](crate::simulation::superpose) for eight replicates, with its work sorted by how often it must be done.
///
/// ```text
/// once a design, border, N:      z̄_q,l,  z − z̄,  D_i,l = Σ_p K_p (z−z̄)(p−i) (z−z̄)(p−l)
/// once a design, N, replicate:   ē_q,l,  V_i,l                                             (LaneGroupedNoise)
/// once more a border:            C_i,l = Σ_p ((z−z̄)(p−i) G_p,l + (z−z̄)(p−l) G_p,i)         (LaneCross)
/// once more a noise level:       means z̄ + σē,  within D + σC + σ²V
/// ```
#[derive(Debug, Clone)]
pub struct LaneSuperposition {
    width: usize,
    counts: Vec<f64>,
    /// `z̄`.
    response: Vec<f64>,
    /// `(z−z̄)(p−l)`, `l = 0…n`, of the phases that share their group with others, rows first.
    uneven: Vec<f64>,
    /// `D`.
    response_within: Vec<f64>,
    /// `z`, for the folds.
    phases: Vec<f64>,
    /// The level that the input visits at each phase.
    visits: Vec<Option<usize>>,
}

/// `C`: what noise and noise-free response have in common within the groups, for eight replicates.
#[derive(Debug, Clone, Default)]
pub struct LaneCross(Vec<Lane>);

impl LaneSuperposition {
    /// For a design with noise-free response `z`, one period, over `samples` samples.
    ///
    /// # Panics
    /// If response and design differ in their period.
    pub fn new(design: &PeriodicDesign, z: &[f64], samples: usize) -> Self {
        let (period, width) = (design.period(), design.order + 1);
        assert_eq!(z.len(), period, "response and design have one period");
        let Grouping { counts, crowded, .. } = Grouping::new(design, samples);
        let count = |p: usize| visits(samples, period, p) as f64;
        let window = |p: usize, l: usize| z[(p + width * period - l) % period];
        let mut response = vec![0.0; counts.len() * width];
        for (p, &q) in design.groups.iter().enumerate() {
            for l in 0..width {
                response[q * width + l] += count(p) * window(p, l);
            }
        }
        for (k, mean) in response.iter_mut().enumerate().filter(|(k, _)| counts[k / width] > 0.0) {
            *mean /= counts[k / width];
        }
        let mut uneven = Vec::with_capacity(crowded.len() * width);
        for &p in &crowded {
            uneven.extend((0..width).map(|l| window(p, l) - response[design.groups[p] * width + l]));
        }
        let mut response_within = vec![0.0; width * width];
        for (z, &p) in uneven.chunks_exact(width).zip(&crowded) {
            for (k, within) in response_within.iter_mut().enumerate() {
                *within += count(p) * z[k / width] * z[k % width];
            }
        }
        let (phases, visits) = (z.to_vec(), design.visits());
        Self { width, counts, response, uneven, response_within, phases, visits }
    }

    /// Statistics to be filled by [`Self::at`].
    pub fn statistics(&self) -> LaneStatistics {
        let mut statistics = LaneStatistics::default();
        self.shape(&mut statistics);
        statistics
    }

    /// Makes [`Self::statistics`] of others, in their memory.
    pub fn shape(&self, statistics: &mut LaneStatistics) {
        statistics.shape(self.width - 1, &self.counts, &self.visits);
    }

    /// What the response has in common with the noise of eight replicates.
    pub fn cross(&self, noise: &LaneGroupedNoise, cross: &mut LaneCross) {
        cross.0.clear();
        cross.0.resize(self.width * self.width, Lane::ZERO);
        widest(Cross { superposition: self, noise, cross });
    }

    /// The statistics at a noise level; `cross` is that of the same noise.
    pub fn at(
        &self,
        (noise, cross): (&LaneGroupedNoise, &LaneCross),
        sigma: f64,
        statistics: &mut LaneStatistics,
    ) {
        widest(At { superposition: self, noise, cross, sigma, statistics });
    }
}

/// [`LaneSuperposition::cross`] on its way.
struct Cross<'a> {
    superposition: &'a LaneSuperposition,
    noise: &'a LaneGroupedNoise,
    cross: &'a mut LaneCross,
}

impl Work for Cross<'_> {
    #[inline(always)]
    fn run(self) {
        let Self { superposition, noise, cross } = self;
        // Loops of a known length unroll.
        match superposition.width {
            2 => superposition.add_cross(noise, cross, 2),
            3 => superposition.add_cross(noise, cross, 3),
            4 => superposition.add_cross(noise, cross, 4),
            5 => superposition.add_cross(noise, cross, 5),
            width => superposition.add_cross(noise, cross, width),
        }
    }
}

impl LaneSuperposition {
    #[inline(always)]
    fn add_cross(&self, noise: &LaneGroupedNoise, cross: &mut LaneCross, width: usize) {
        let cross = &mut cross.0[..width * width];
        for (fold, z) in noise.crowded.chunks_exact(width).zip(self.uneven.chunks_exact(width)) {
            keep_apart();
            for i in 0..width {
                for l in 0..=i {
                    cross[i * width + l] += fold[l] * z[i] + fold[i] * z[l];
                }
            }
        }
    }
}

/// [`LaneSuperposition::at`] on its way.
struct At<'a> {
    superposition: &'a LaneSuperposition,
    noise: &'a LaneGroupedNoise,
    cross: &'a LaneCross,
    sigma: f64,
    statistics: &'a mut LaneStatistics,
}

impl Work for At<'_> {
    #[inline(always)]
    fn run(self) {
        let Self {
            superposition: LaneSuperposition { width, response, response_within, phases, .. },
            noise,
            cross: LaneCross(cross),
            sigma,
            statistics,
        } = self;
        for ((mean, z), e) in statistics.means.iter_mut().zip(response).zip(&noise.means) {
            keep_apart();
            *mean = *e * sigma + Lane::splat(*z);
        }
        statistics.folds.resize(noise.folds.len(), Lane::ZERO);
        for ((fold, z), e) in statistics.folds.iter_mut().zip(phases).zip(&noise.folds) {
            keep_apart();
            *fold = *e * sigma + Lane::splat(*z);
        }
        statistics.left.resize(noise.left.len(), Lane::ZERO);
        for (left, e) in statistics.left.iter_mut().zip(&noise.left) {
            *left = *e * (sigma * sigma);
        }
        for i in 0..*width {
            for l in 0..=i {
                let k = i * width + l;
                let within = (noise.within[k] * sigma + cross[k]) * sigma + Lane::splat(response_within[k]);
                statistics.within[k] = within;
                statistics.within[l * width + i] = within;
            }
        }
    }
}
