//! Superposition for eight replicates abreast.

use super::design::PeriodicDesign;
use super::noise::{LaneRecords, LaneView};
use super::superposition::NoiseMoments;
use crate::estimators::pulse::lanes::LaneStatistics;
use crate::lanes::{LANES, Lane, Work, keep_apart, widest};
use std::ops::Range;

/// The [`NoiseMoments`] of eight replicates, for one period and number of samples.
#[derive(Debug, Clone, PartialEq)]
pub struct LaneMoments {
    order: usize,
    products: Vec<Lane>,
    folds: Vec<Lane>,
}

impl LaneMoments {
    /// Zeros for this order and period, to be overwritten.
    pub fn zeros(order: usize, period: usize) -> Self {
        let width = order + 1;
        Self { order, products: vec![Lane::ZERO; width * width], folds: vec![Lane::ZERO; period * width] }
    }

    /// Puts a replicate into a lane.
    ///
    /// # Panics
    /// If order or period differ.
    pub fn set(&mut self, lane: usize, moments: &NoiseMoments) {
        assert_eq!(
            (self.order, self.folds.len()),
            (moments.order, moments.folds.len()),
            "lanes share their design"
        );
        let into = self.products.iter_mut().chain(&mut self.folds);
        into.zip(moments.products.iter().chain(&moments.folds)).for_each(|(lane8, x)| lane8.0[lane] = *x);
    }

    /// Puts neighbouring replicates of a pass into lanes `into`: those from lane `from` of the pass on, at one of its checkpoints and
    /// periods. The same to the bit as [`NoiseMoments::from_checkpoint`], one by one.
    ///
    /// # Panics
    /// If order or period differ, or lanes are named that do not exist.
    pub fn take(
        &mut self,
        into: Range<usize>,
        records: &LaneRecords,
        from: usize,
        (checkpoint, period): (usize, usize),
    ) {
        let view = records.view(checkpoint, period, from);
        widest(Take { moments: self, into, view });
    }
}

/// [`LaneMoments::take`] on its way.
struct Take<'a> {
    moments: &'a mut LaneMoments,
    into: Range<usize>,
    view: LaneView<'a>,
}

impl Work for Take<'_> {
    #[inline(always)]
    fn run(self) {
        let Self { moments, into, view } = self;
        if into == (0..LANES) {
            moments.take_abreast::<LANES>(0, view);
        } else if into.len() == LANES / 2 {
            moments.take_abreast::<{ LANES / 2 }>(into.start, view);
        } else {
            assert_eq!(into.len(), 1, "passes are 1, 4, 8 or 16 lanes wide");
            moments.take_abreast::<1>(into.start, view);
        }
    }
}

impl LaneMoments {
    /// Lagged folds and lag products from plain folds, autoproducts and edges.
    #[inline(always)]
    fn take_abreast<const L: usize>(&mut self, at: usize, view: LaneView<'_>) {
        let (order, width) = (self.order, self.order + 1);
        let LaneView { samples, head, tail, autoproducts, fold } = view;
        let period = self.folds.len() / width;
        let place = |lane: &mut Lane, value: [f64; L]| lane.0[at..at + L].copy_from_slice(&value);
        for l in 0..width {
            let shift = l % period;
            for p in 0..period {
                keep_apart();
                let phase = if p >= shift { p - shift } else { p + period - shift };
                place(&mut self.folds[p * width + l], fold.row::<L>(phase));
            }
            for back in 1..=l {
                let (head, tail) = (head.row::<L>(order - back), tail.row::<L>(order - back));
                let begun = &mut self.folds[(l - back) % period * width + l].0[at..at + L];
                begun.iter_mut().zip(head).for_each(|(sum, e)| *sum += e);
                let ended = &mut self.folds[(samples + l - back) % period * width + l].0[at..at + L];
                ended.iter_mut().zip(tail).for_each(|(sum, e)| *sum -= e);
            }
        }
        for k in 0..width {
            let mut sum = autoproducts.row::<L>(k);
            for i in 0..width - k {
                keep_apart();
                if i > 0 {
                    let (e, before) = (head.row::<L>(order - i), tail.row::<L>(order - i));
                    let (e_k, before_k) = (head.row::<L>(order - i - k), tail.row::<L>(order - i - k));
                    for lane in 0..L {
                        sum[lane] += e[lane] * e_k[lane] - before[lane] * before_k[lane];
                    }
                }
                place(&mut self.products[i * width + i + k], sum);
                place(&mut self.products[(i + k) * width + i], sum);
            }
        }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulation::noise::{NoisePass, NoisePlan, Width};

    #[test]
    fn lanes_of_a_pass_are_its_replicates_to_the_bit() {
        let plan = NoisePlan {
            ar: vec![-1.2, 0.5],
            ma: vec![],
            lags: 3,
            periods: vec![2, 14, 28],
            checkpoints: vec![5, 200, 333],
            burn_in: 40,
        };
        for width in Width::available() {
            let mut pass = NoisePass::new(plan.clone(), width).expect("a valid plan");
            for (checkpoint, period) in (0..9).map(|k| (k / 3, k % 3)) {
                let zeros = LaneMoments::zeros(plan.lags, plan.periods[period]);
                let mut slow = vec![zeros.clone(); 2];
                pass.run(1, 0, 0..16, |r, record| {
                    let moments =
                        NoiseMoments::from_checkpoint(&record.head, &record.checkpoints[checkpoint], period);
                    slow[r as usize / LANES].set(r as usize % LANES, &moments);
                });
                let mut fast = vec![zeros; 2];
                pass.run_abreast(1, 0, 0..16, |first, records| {
                    let abreast = records.lanes().min(LANES);
                    for from in (0..records.lanes()).step_by(abreast) {
                        let at = first as usize + from;
                        let into = at % LANES..at % LANES + abreast;
                        fast[at / LANES].take(into, records, from, (checkpoint, period));
                    }
                });
                assert!(fast == slow, "{width:?}, checkpoint {checkpoint}, period {period}");
            }
        }
    }
}
