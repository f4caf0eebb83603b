//! What the noise of eight replicates contributes to the statistics of a pulse experiment.

use crate::simulation::NoiseMoments;
use crate::simulation::superposition::visits;
use std::ops::Range;
use switchback_noise::lanes::{LANES, Lane, Work, keep_apart, widest};
use switchback_noise::{LaneRecords, LaneView};

/// The [`NoiseMoments`] of eight replicates, for one period and number of samples.
#[derive(Debug, Clone, PartialEq)]
pub struct LaneMoments {
    order: usize,
    pub(super) products: Vec<Lane>,
    pub(super) folds: Vec<Lane>,
    /// What the folds leave, where it is asked for.
    pub(super) left: Vec<Lane>,
}

impl LaneMoments {
    /// Zeros for this order and period, to be overwritten.
    pub fn zeros(order: usize, period: usize) -> Self {
        let width = order + 1;
        let (products, folds) = (vec![Lane::ZERO; width * width], vec![Lane::ZERO; period * width]);
        Self { order, products, folds, left: Vec::new() }
    }

    /// With what the folds leave up to lag `lags` besides, for the instrumental method.
    #[must_use]
    pub fn with_left(self, lags: usize) -> Self {
        Self { left: vec![Lane::ZERO; lags + 1], ..self }
    }

    /// Puts a replicate into a lane.
    ///
    /// # Panics
    /// If order or period differ, or the replicate has fewer lags.
    pub fn set(&mut self, lane: usize, moments: &NoiseMoments) {
        assert_eq!(
            (self.order, self.folds.len()),
            (moments.order, moments.folds.len()),
            "lanes share their design"
        );
        assert!(self.left.len() <= moments.left.len(), "the replicate has the lags that are asked for");
        let put = |into: &mut [Lane], from: &[f64]| {
            into.iter_mut().zip(from).for_each(|(lane8, x)| lane8.0[lane] = *x);
        };
        put(&mut self.products, &moments.products);
        put(&mut self.folds, &moments.folds);
        put(&mut self.left, &moments.left);
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

/// `1/K_p`, 0 of a phase without samples.
#[inline(always)]
fn share(samples: usize, period: usize, p: usize) -> f64 {
    match visits(samples, period, p) {
        0 => 0.0,
        count => 1.0 / count as f64,
    }
}

impl LaneMoments {
    /// Lagged folds and lag products from plain folds, autoproducts and edges.
    #[inline(always)]
    fn take_abreast<const L: usize>(&mut self, at: usize, view: LaneView<'_>) {
        let width = self.order + 1;
        let LaneView { samples, lags, head, tail, autoproducts, fold } = view;
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
                let (head, tail) = (head.row::<L>(lags - back), tail.row::<L>(lags - back));
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
                    let (e, before) = (head.row::<L>(lags - i), tail.row::<L>(lags - i));
                    let (e_k, before_k) = (head.row::<L>(lags - i - k), tail.row::<L>(lags - i - k));
                    for lane in 0..L {
                        sum[lane] += e[lane] * e_k[lane] - before[lane] * before_k[lane];
                    }
                }
                place(&mut self.products[i * width + i + k], sum);
                place(&mut self.products[(i + k) * width + i], sum);
            }
        }
        for k in 0..self.left.len() {
            // Σ_p G_p,0 G_p,k / K_p: the lagged fold is the plain one, both edges moved by k.
            let mut sum = autoproducts.row::<L>(k);
            let mean = |p: usize| {
                let share = share(samples, period, p);
                fold.row::<L>(p).map(|x| x * share)
            };
            let mut take_out = |mean: [f64; L], x: [f64; L], sign: f64| {
                for lane in 0..L {
                    sum[lane] -= sign * (mean[lane] * x[lane]);
                }
            };
            let shift = k % period;
            for p in 0..period {
                keep_apart();
                let phase = if p >= shift { p - shift } else { p + period - shift };
                take_out(mean(p), fold.row::<L>(phase), 1.0);
            }
            for back in 1..=k {
                take_out(mean((k - back) % period), head.row::<L>(lags - back), 1.0);
                take_out(mean((samples + k - back) % period), tail.row::<L>(lags - back), -1.0);
            }
            place(&mut self.left[k], sum);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use switchback_noise::{NoisePass, NoisePlan, Width};

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
                    let moments = NoiseMoments::from_checkpoint(
                        plan.lags,
                        &record.head,
                        &record.checkpoints[checkpoint],
                        period,
                    );
                    slow[r as usize / LANES].set(r as usize % LANES, &moments);
                });
                let mut fast = vec![zeros; 2];
                pass.run_batched(1, 0, 0..16, |first, records| {
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
