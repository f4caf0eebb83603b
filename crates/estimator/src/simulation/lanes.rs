//! Superposition for eight replicates abreast.

use super::design::PeriodicDesign;
use super::superposition::NoiseMoments;
use crate::estimators::pulse::lanes::LaneStatistics;
use crate::lanes::{Lane, Work, keep_apart, widest};

/// The [`NoiseMoments`] of eight replicates, for one period and number of samples.
#[derive(Debug, Clone, PartialEq)]
pub struct LaneMoments {
    order: usize,
    counts: Vec<f64>,
    products: Vec<Lane>,
    folds: Vec<Lane>,
}

impl LaneMoments {
    /// Eight times the same replicate, to be [overwritten](Self::set).
    pub fn splat(moments: &NoiseMoments) -> Self {
        Self {
            order: moments.order,
            counts: moments.counts.clone(),
            products: moments.products.iter().map(|x| Lane::splat(*x)).collect(),
            folds: moments.folds.iter().map(|x| Lane::splat(*x)).collect(),
        }
    }

    /// Puts a replicate into a lane.
    ///
    /// # Panics
    /// If order, period or number of samples differ from the others'.
    pub fn set(&mut self, lane: usize, moments: &NoiseMoments) {
        assert_eq!((self.order, &self.counts), (moments.order, &moments.counts), "lanes share their design");
        let into = self.products.iter_mut().chain(&mut self.folds);
        into.zip(moments.products.iter().chain(&moments.folds)).for_each(|(lane8, x)| lane8.0[lane] = *x);
    }
}

/// [`superpose`](super::superpose) for eight replicates, with its work sorted by how often it must be done.
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
        let Self {
            superposition: LaneSuperposition { width, groups, counts, uneven, noise, noise_within, cross, .. },
            moments,
        } = self;
        let width = *width;
        noise.fill(Lane::ZERO);
        for (fold, &q) in moments.folds.chunks_exact(width).zip(&*groups) {
            for (sum, x) in noise[q * width..(q + 1) * width].iter_mut().zip(fold) {
                keep_apart();
                *sum += *x;
            }
        }
        noise_within.copy_from_slice(&moments.products);
        for (mean, &count) in noise.chunks_exact_mut(width).zip(&*counts).filter(|(_, count)| **count > 0.0) {
            keep_apart();
            for i in 0..width {
                keep_apart();
                let sum = mean[i];
                mean[i] = sum * (1.0 / count);
                for l in 0..=i {
                    keep_apart();
                    noise_within[i * width + l] -= sum * mean[l];
                }
            }
        }
        cross.fill(Lane::ZERO);
        for (p, z) in &*uneven {
            let fold = &moments.folds[p * width..(p + 1) * width];
            for i in 0..width {
                for l in 0..=i {
                    keep_apart();
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
