//! The one pass over the noise.

use std::ops::Range;

use super::aligned::Aligned;
use super::kernels::{Advance, Fold, MovingAverage};
use super::lane_records::{LaneCheckpoint, LaneRecords};
use super::plan::{NoisePlan, NoisePlanError};
use super::record::NoiseRecord;
use super::white::{BLOCK, StreamId, WhiteNoise};
use super::width::Width;

/// Runs a [`NoisePlan`] over many replicates, a lane each, in memory of its own that grows with neither
/// samples nor replicates.
///
/// Sums of products are taken over blocks of [`BLOCK`] samples and the blocks then added up, folds are added
/// up in order, all in `f64`: at N = 10⁶ the rounding error of a sum is below 10⁻¹³ of the sum of its terms'
/// moduli, far below the Monte-Carlo error. Results of one replicate are the same bits whatever the width,
/// and whatever the other replicates of the call. Threads each take a pass of their own (a clone) and ranges
/// of replicates.
///
/// ```
/// # use switchback_noise::{NoisePass, NoisePlan, Width};
/// let plan = NoisePlan {
///     ar: vec![-0.5], ma: vec![], lags: 1, periods: vec![10], checkpoints: vec![10_000], burn_in: 60,
/// };
/// let mut variances = Vec::new();
/// NoisePass::new(plan, Width::detect())?.run(1, 0, 0..20, |_, record| {
///     variances.push(record.checkpoints[0].lag_products[(0, 0)] / 10_000.0);
/// });
/// let mean = variances.iter().sum::<f64>() / 20.0;
/// assert!((mean - 1.0 / (1.0 - 0.25)).abs() < 0.02);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct NoisePass {
    plan: NoisePlan,
    width: Width,
    /// Rows of w: `ma.len()` past ones, then the block. Empty when there is no moving average.
    w: Aligned,
    /// Rows of e: `plan.history()` past ones, then the block.
    e: Aligned,
    /// Autoproducts of the whole blocks, and of the current one.
    products: Aligned,
    block_products: Aligned,
    folds: Vec<FoldSums>,
    records: LaneRecords,
}

/// Running sums of one period.
#[derive(Clone, Debug)]
struct FoldSums {
    period: usize,
    phase: usize,
    sums: Aligned,
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
            sums: Aligned::zeros(period * lanes),
        });
        Ok(Self {
            width,
            w: if plan.ma.is_empty() {
                Aligned::zeros(0)
            } else {
                Aligned::zeros((plan.ma.len() + BLOCK) * lanes)
            },
            e: Aligned::zeros((plan.history() + BLOCK) * lanes),
            products: Aligned::zeros((plan.lags + 1) * lanes),
            block_products: Aligned::zeros((plan.lags + 1) * lanes),
            folds: folds.collect(),
            records: LaneRecords::zeros(&plan, lanes),
            plan,
        })
    }

    /// Visits the record of every replicate, in order.
    ///
    /// A range that is a multiple of [`Width::lanes`] wastes no lane. Allocates nothing for the replicates
    /// themselves; `visit` clones what it keeps.
    pub fn run(
        &mut self,
        seed: u64,
        experiment: u32,
        replicates: Range<u32>,
        mut visit: impl FnMut(u32, &NoiseRecord),
    ) {
        let mut record = NoiseRecord::zeros(&self.plan);
        self.run_batched(seed, experiment, replicates.clone(), |first, records| {
            for (lane, replicate) in (first..replicates.end).take(records.lanes()).enumerate() {
                records.read(lane, &mut record);
                visit(replicate, &record);
            }
        });
    }

    /// Visits the records of as many replicates as there are lanes at a time, named by the first of them; the lanes after the last
    /// replicate of the range hold others. For those who go on in lanes.
    pub fn run_batched(
        &mut self,
        seed: u64,
        experiment: u32,
        replicates: Range<u32>,
        mut visit: impl FnMut(u32, &LaneRecords),
    ) {
        let mut noise =
            WhiteNoise::new(self.width, StreamId { seed, experiment, replicate: replicates.start });
        for first in replicates.clone().step_by(self.width.lanes()) {
            noise.restart(experiment, first);
            self.run_lanes(&mut noise);
            visit(first, &self.records);
        }
    }

    /// Fills the records, one a lane.
    fn run_lanes(&mut self, noise: &mut WhiteNoise) {
        self.rest();
        // Samples are counted from −burn_in; `origin` is t = 0. A block is cut where something has to be done
        // between two samples.
        let (origin, history) = (self.plan.burn_in, self.plan.history());
        let (mut start, mut next) = (0, 0);
        while let Some(last) = self.plan.checkpoints.last()
            && start < origin + last
        {
            self.draw(noise);
            let end = start + BLOCK;
            let mut t = start;
            while t < end && next < self.plan.checkpoints.len() {
                let event = if t < origin { origin } else { origin + self.plan.checkpoints[next] };
                let stop = event.min(end);
                let rows = history + t - start..history + stop - start;
                self.advance(rows.clone());
                if t >= origin {
                    self.fold(rows.clone());
                }
                if stop == origin {
                    self.begin(rows.end);
                } else if stop == event {
                    self.record(next, rows.end);
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

    /// The next block of w, and of C w in the rows of e.
    fn draw(&mut self, noise: &mut WhiteNoise) {
        let lanes = self.width.lanes();
        let block = &mut self.e[self.plan.history() * lanes..];
        if self.plan.ma.is_empty() {
            noise.fill(block);
        } else {
            noise.fill(&mut self.w[self.plan.ma.len() * lanes..]);
            self.width.run(MovingAverage { ma: &self.plan.ma, w: &self.w, x: block });
        }
    }

    /// Turns C w into e over some rows, and adds up their products.
    fn advance(&mut self, rows: Range<usize>) {
        let lanes = self.width.lanes();
        let history = self.plan.history();
        let e = &mut self.e[(rows.start - history) * lanes..rows.end * lanes];
        self.width.run(Advance { ar: &self.plan.ar, history, e, sums: &mut self.block_products });
    }

    /// Adds some rows of e to the folds.
    fn fold(&mut self, rows: Range<usize>) {
        let lanes = self.width.lanes();
        let e = &self.e[rows.start * lanes..rows.end * lanes];
        for fold in &mut self.folds {
            self.width.run(Fold { e, fold: &mut fold.sums, phase: fold.phase });
            fold.phase = (fold.phase + rows.len()) % fold.period;
        }
    }

    /// Closes the block: its products join the total, its last rows become the past.
    fn end_block(&mut self) {
        let lanes = self.width.lanes();
        for (total, block) in self.products.iter_mut().zip(self.block_products.iter_mut()) {
            *total += *block;
            *block = 0.0;
        }
        self.e.copy_within(BLOCK * lanes.., 0);
        if !self.w.is_empty() {
            self.w.copy_within(BLOCK * lanes.., 0);
        }
    }

    /// Begins the sums at t = 0, which comes just before row `to`: forgets the products of the burn-in,
    /// records the head.
    fn begin(&mut self, to: usize) {
        self.products.fill(0.0);
        self.block_products.fill(0.0);
        let (n, lanes) = (self.plan.lags, self.width.lanes());
        self.records.head.copy_from_slice(&self.e[(to - n) * lanes..to * lanes]);
    }

    /// Records checkpoint `index`, which comes just before row `to`.
    fn record(&mut self, index: usize, to: usize) {
        let (n, lanes) = (self.plan.lags, self.width.lanes());
        let LaneCheckpoint { autoproducts, folds, tail, .. } = &mut self.records.checkpoints[index];
        tail.copy_from_slice(&self.e[(to - n) * lanes..to * lanes]);
        let products = self.products.iter().zip(&*self.block_products);
        autoproducts.iter_mut().zip(products).for_each(|(sum, (total, block))| *sum = total + block);
        for sums in folds {
            let period = sums.len() / lanes;
            read_fold(sums, period, &self.folds);
        }
    }
}

/// Sums the fold of `period` out of the running fold of a multiple of it.
fn read_fold(sums: &mut [f64], period: usize, folds: &[FoldSums]) {
    let fold = folds.iter().find(|f| f.period % period == 0).expect("every period divides a running one");
    let mut runs = fold.sums.chunks_exact(sums.len());
    if let Some(first) = runs.next() {
        sums.copy_from_slice(first);
    }
    for run in runs {
        sums.iter_mut().zip(run).for_each(|(sum, x)| *sum += x);
    }
}
