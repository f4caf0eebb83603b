//! The statistics of eight replicates at any noise level.

use super::moments::LaneMoments;
use crate::estimators::pulse::lanes::LaneStatistics;
use crate::lanes::{Lane, Work, keep_apart, widest};
use crate::simulation::PeriodicDesign;

/// [`superpose`](crate::simulation::superpose) for eight replicates, with its work sorted by how often it must be done.
///
/// ```text
/// once a design, border, N:     z̄_q,l,  z − z̄,  D_i,l = Σ_p K_p (z−z̄)(p−i) (z−z̄)(p−l)
/// once more a replicate:        ē_q,l,  V_i,l = Σ_t e(t−i)e(t−l) − Σ_q K_q ē_q,i ē_q,l,
///                               C_i,l = Σ_p ((z−z̄)(p−i) G_p,l + (z−z̄)(p−l) G_p,i)
/// once more a noise level:      means z̄ + σē,  within D + σC + σ²V
/// ```
#[derive(Debug, Clone)]
pub struct LaneSuperposition {
    width: usize,
    /// Groups phase by phase.
    groups: Vec<usize>,
    counts: Vec<f64>,
    /// `z̄`.
    response: Vec<f64>,
    /// Phases at which the response differs from its group's mean, with `(z−z̄)(p−l)`, `l = 0…n`.
    uneven: Vec<(usize, Vec<f64>)>,
    /// `D`.
    response_within: Vec<f64>,
    /// `ē`.
    noise: Vec<Lane>,
    /// `V`.
    noise_within: Vec<Lane>,
    /// `C`.
    cross: Vec<Lane>,
}

impl LaneSuperposition {
    /// For a design with noise-free response `z`, one period, over `samples` samples.
    ///
    /// # Panics
    /// If response and design differ in their period.
    pub fn new(design: &PeriodicDesign, z: &[f64], samples: usize) -> Self {
        let (period, width) = (design.period(), design.order + 1);
        assert_eq!(z.len(), period, "response and design have one period");
        let count = |p: usize| ((samples + period - 1 - p) / period) as f64;
        let window = |p: usize, l: usize| z[(p + width * period - l) % period];
        let mut counts = vec![0.0; design.group_count()];
        let mut response = vec![0.0; counts.len() * width];
        for (p, &q) in design.groups.iter().enumerate() {
            counts[q] += count(p);
            for l in 0..width {
                response[q * width + l] += count(p) * window(p, l);
            }
        }
        for (k, mean) in response.iter_mut().enumerate().filter(|(k, _)| counts[k / width] > 0.0) {
            *mean /= counts[k / width];
        }
        let phases = |q: usize| design.groups.iter().filter(|g| **g == q).count();
        let uneven: Vec<(usize, Vec<f64>)> = (0..period)
            .filter(|&p| phases(design.groups[p]) > 1)
            .map(|p| (p, (0..width).map(|l| window(p, l) - response[design.groups[p] * width + l]).collect()))
            .collect();
        let mut response_within = vec![0.0; width * width];
        for (p, z) in &uneven {
            for (k, within) in response_within.iter_mut().enumerate() {
                *within += count(*p) * z[k / width] * z[k % width];
            }
        }
        Self {
            width,
            groups: design.groups.clone(),
            noise: vec![Lane::ZERO; response.len()],
            noise_within: vec![Lane::ZERO; width * width],
            cross: vec![Lane::ZERO; width * width],
            counts,
            response,
            uneven,
            response_within,
        }
    }

    /// Statistics to be filled by [`Self::at`].
    pub fn statistics(&self) -> LaneStatistics {
        LaneStatistics::new(self.width - 1, self.counts.clone())
    }

    /// Takes in the noise of eight replicates.
    pub fn load(&mut self, moments: &LaneMoments) {
        widest(Load { superposition: self, moments });
    }

    /// The statistics at a noise level.
    pub fn at(&self, sigma: f64, statistics: &mut LaneStatistics) {
        widest(At { superposition: self, sigma, statistics });
    }
}

/// [`LaneSuperposition::load`] on its way.
struct Load<'a> {
    superposition: &'a mut LaneSuperposition,
    moments: &'a LaneMoments,
}

impl Work for Load<'_> {
    #[inline(always)]
    fn run(self) {
        let Self { superposition, moments } = self;
        // Loops of a known length unroll.
        match superposition.width {
            2 => superposition.take_in(moments, 2),
            3 => superposition.take_in(moments, 3),
            4 => superposition.take_in(moments, 4),
            5 => superposition.take_in(moments, 5),
            width => superposition.take_in(moments, width),
        }
    }
}

impl LaneSuperposition {
    #[inline(always)]
    fn take_in(&mut self, moments: &LaneMoments, width: usize) {
        let Self { groups, counts, uneven, noise, noise_within, cross, .. } = self;
        noise.fill(Lane::ZERO);
        for (fold, &q) in moments.folds.chunks_exact(width).zip(&*groups) {
            keep_apart();
            let sums = &mut noise[q * width..(q + 1) * width];
            for l in 0..width {
                sums[l] += fold[l];
            }
        }
        noise_within.copy_from_slice(&moments.products);
        let noise_within = &mut noise_within[..width * width];
        for (mean, &count) in noise.chunks_exact_mut(width).zip(&*counts).filter(|(_, count)| **count > 0.0) {
            keep_apart();
            let share = 1.0 / count;
            for i in 0..width {
                let sum = mean[i];
                mean[i] = sum * share;
                for l in 0..=i {
                    noise_within[i * width + l] -= sum * mean[l];
                }
            }
        }
        cross.fill(Lane::ZERO);
        let cross = &mut cross[..width * width];
        for (p, z) in &*uneven {
            keep_apart();
            let (fold, z) = (&moments.folds[p * width..(p + 1) * width], &z[..width]);
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
    sigma: f64,
    statistics: &'a mut LaneStatistics,
}

impl Work for At<'_> {
    #[inline(always)]
    fn run(self) {
        let Self {
            superposition:
                LaneSuperposition { width, response, response_within, noise, noise_within, cross, .. },
            sigma,
            statistics,
        } = self;
        for ((mean, z), e) in statistics.means.iter_mut().zip(response).zip(noise) {
            keep_apart();
            *mean = *e * sigma + Lane::splat(*z);
        }
        for i in 0..*width {
            for l in 0..=i {
                let k = i * width + l;
                let within = (noise_within[k] * sigma + cross[k]) * sigma + Lane::splat(response_within[k]);
                statistics.within[k] = within;
                statistics.within[l * width + i] = within;
            }
        }
    }
}
