//! The one pass over the noise.

use std::ops::Range;

use super::kernels::{AutoProducts, AutoRegression, Fold, MovingAverage};
use super::plan::{NoisePlan, NoisePlanError};
use super::record::NoiseRecord;
use super::white::{BLOCK, StreamId, WhiteNoise};
use super::width::Width;

/// Runs a [`NoisePlan`] over many replicates, a lane each, in memory of its own that grows with neither samples nor replicates.
///
/// Sums of products are taken over blocks of 64 samples and the blocks then added up, folds are added up in order, all in `f64`: at N = 10⁶
/// the rounding error of a sum is of the order of 10⁻¹³ of the sum of its terms' moduli, far below the Monte-Carlo error. Results of
/// one replicate are the same bits whatever the width, and whatever the other replicates of the call.
///
/// ```
/// # use switchback_estimator::simulation::noise::{NoisePass, NoisePlan, Width};
/// let plan = NoisePlan {
///     ar: vec![-0.5], ma: vec![], lags: 1, periods: vec![10], checkpoints: vec![10_000], burn_in: 60,
/// };
/// let mut variances = Vec::new();
/// NoisePass::new(plan, Width::detect())?.run(1, 0, 0..20, |_, record| {
///     variances.push(record.checkpoints[0].lag_products[(0, 0)] / 10_000.0);
/// });
/// let mean = variances.iter().sum::<f64>() / 20.0;
/// assert!((mean - 1.0 / (1.0 - 0.25)).abs() < 0.02);
/// # Ok::<(), switchback_estimator::simulation::noise::NoisePlanError>(())
/// ```
#[derive(Clone, Debug)]
pub struct NoisePass {
    plan: NoisePlan,
    width: Width,
    /// Rows of w: `ma.len()` past ones, then the block. Empty when there is no moving average.
    w: Vec<f64>,
    /// Rows of e: `plan.history()` past ones, then the block.
    e: Vec<f64>,
    /// Autoproducts of the whole blocks, and of the current one.
    products: Vec<f64>,
    block_products: Vec<f64>,
    /// Autoproducts of one replicate.
    autoproducts: Vec<f64>,
    folds: Vec<FoldSums>,
    records: Vec<NoiseRecord>,
}

/// Running sums of one period.
#[derive(Clone, Debug)]
struct FoldSums {
    period: usize,
    phase: usize,
    sums: Vec<f64>,
}

impl NoisePass {
    /// Allocates what the pass needs.
    ///
    /// # Errors
    /// If the plan is not valid.
    pub fn new(plan: NoisePlan, width: Width) -> Result<Self, NoisePlanError> {
        plan.validate()?;
        let lanes = width.lanes();
        // A period that divides another of the list is read off the longer fold.
        let mut periods = plan.periods.clone();
        periods.sort_unstable();
        periods.dedup();
        let longest = |&period: &usize| !periods.iter().any(|&p| p > period && p % period == 0);
        let folds = periods.iter().copied().filter(longest).map(|period| FoldSums {
            period,
            phase: 0,
            sums: vec![0.0; period * lanes],
        });
        Ok(Self {
            width,
            w: if plan.ma.is_empty() { vec![] } else { vec![0.0; (plan.ma.len() + BLOCK) * lanes] },
            e: vec![0.0; (plan.history() + BLOCK) * lanes],
            products: vec![0.0; (plan.lags + 1) * lanes],
            block_products: vec![0.0; (plan.lags + 1) * lanes],
            autoproducts: vec![0.0; plan.lags + 1],
            folds: folds.collect(),
            records: vec![NoiseRecord::zeros(&plan); lanes],
            plan,
        })
    }

    /// Visits the record of every replicate, in order.
    ///
    /// A range that is a multiple of [`Width::lanes`] wastes no lane.
    pub fn run(
        &mut self,
        seed: u64,
        experiment: u32,
        replicates: Range<u32>,
        mut visit: impl FnMut(u32, &NoiseRecord),
    ) {
        let mut noise =
            WhiteNoise::new(self.width, StreamId { seed, experiment, replicate: replicates.start });
        for first in replicates.clone().step_by(self.width.lanes()) {
            noise.restart(experiment, first);
            self.run_lanes(&mut noise);
            for (replicate, record) in (first..replicates.end).zip(&self.records) {
                visit(replicate, record);
            }
        }
    }

    /// Fills the records, one a lane.
    fn run_lanes(&mut self, noise: &mut WhiteNoise) {
        self.rest();
        // Samples from −burn_in; `origin` is t = 0.
        let origin = self.plan.burn_in;
        let mut start = 0;
        let mut next = 0;
        if origin == 0 {
            self.record_head(self.plan.history());
        }
        while next < self.plan.checkpoints.len() {
            self.filter(noise);
            let end = start + BLOCK;
            let mut t = start.max(origin.min(end));
            if start < origin && origin <= end {
                self.record_head(self.plan.history() + origin - start);
            }
            while t < end && next < self.plan.checkpoints.len() {
                let checkpoint = origin + self.plan.checkpoints[next];
                let stop = checkpoint.min(end);
                self.accumulate(self.plan.history() + t - start, self.plan.history() + stop - start);
                if stop == checkpoint {
                    self.record(next, self.plan.history() + stop - start);
                    next += 1;
                }
                t = stop;
            }
            self.end_block();
            start = end;
        }
    }

    /// Forgets everything: rest before the first sample, no sums.
    fn rest(&mut self) {
        for rows in [&mut self.w, &mut self.e, &mut self.products, &mut self.block_products] {
            rows.fill(0.0);
        }
        for fold in &mut self.folds {
            fold.sums.fill(0.0);
            fold.phase = 0;
        }
    }

    /// The next block of e.
    fn filter(&mut self, noise: &mut WhiteNoise) {
        let lanes = self.width.lanes();
        let history = self.plan.history();
        let block = &mut self.e[history * lanes..];
        if self.plan.ma.is_empty() {
            noise.fill(block);
        } else {
            noise.fill(&mut self.w[self.plan.ma.len() * lanes..]);
            self.width.run(MovingAverage { ma: &self.plan.ma, w: &self.w, x: block });
        }
        self.width.run(AutoRegression { ar: &self.plan.ar, history, e: &mut self.e });
    }

    /// Adds rows `from..to` of e to the sums.
    fn accumulate(&mut self, from: usize, to: usize) {
        let lanes = self.width.lanes();
        let e = &self.e[(from - self.plan.lags) * lanes..to * lanes];
        self.width.run(AutoProducts { e, sums: &mut self.block_products });
        let e = &self.e[from * lanes..to * lanes];
        for fold in &mut self.folds {
            self.width.run(Fold { e, fold: &mut fold.sums, phase: fold.phase });
            fold.phase = (fold.phase + to - from) % fold.period;
        }
    }

    /// Closes the block: its products join the total, its last rows become the past.
    fn end_block(&mut self) {
        let lanes = self.width.lanes();
        for (total, block) in self.products.iter_mut().zip(&mut self.block_products) {
            *total += *block;
            *block = 0.0;
        }
        self.e.copy_within(BLOCK * lanes.., 0);
        if !self.w.is_empty() {
            self.w.copy_within(BLOCK * lanes.., 0);
        }
    }

    /// Records the n rows of e before row `to` as the head.
    fn record_head(&mut self, to: usize) {
        let n = self.plan.lags;
        let (e, lanes) = (&self.e, self.width.lanes());
        for (l, record) in self.records.iter_mut().enumerate() {
            for (i, head) in record.head.iter_mut().enumerate() {
                *head = e[(to - n + i) * lanes + l];
            }
        }
    }

    /// Records checkpoint `index`, which comes just before row `to`.
    fn record(&mut self, index: usize, to: usize) {
        let n = self.plan.lags;
        let lanes = self.width.lanes();
        for (l, record) in self.records.iter_mut().enumerate() {
            let NoiseRecord { head, checkpoints } = record;
            let checkpoint = &mut checkpoints[index];
            for (i, tail) in checkpoint.tail.iter_mut().enumerate() {
                *tail = self.e[(to - n + i) * lanes + l];
            }
            for (k, sum) in self.autoproducts.iter_mut().enumerate() {
                *sum = self.products[k * lanes + l] + self.block_products[k * lanes + l];
            }
            checkpoint.set_lag_products(&self.autoproducts, head);
            for (sums, &period) in checkpoint.folds.iter_mut().zip(&self.plan.periods) {
                read_fold(sums, period, &self.folds, |row| row * lanes + l);
            }
        }
    }
}

/// Sums the fold of `period` out of the running fold of a multiple of it.
fn read_fold(sums: &mut [f64], period: usize, folds: &[FoldSums], at: impl Fn(usize) -> usize) {
    let fold = folds.iter().find(|f| f.period % period == 0).expect("every period divides a running one");
    sums.fill(0.0);
    for row in 0..fold.period {
        sums[row % period] += fold.sums[at(row)];
    }
}
