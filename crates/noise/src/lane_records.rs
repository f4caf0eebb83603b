//! What a pass over the noise records, as the lanes hold it.

use super::aligned::Aligned;
use super::plan::NoisePlan;
use super::record::NoiseRecord;

/// The [`NoiseRecord`]s of neighbouring replicates, a lane each, as the pass leaves them.
///
/// Every number of a record is a row here, one value a lane. Lag products other than `Σ e(t) e(t−k)` follow from these and from the edges.
#[derive(Clone, Debug)]
pub struct LaneRecords {
    pub(super) lanes: usize,
    /// `e(−n) … e(−1)`, oldest first.
    pub(super) head: Aligned,
    pub(super) checkpoints: Vec<LaneCheckpoint>,
}

/// Sums over the first N samples.
#[derive(Clone, Debug)]
pub(super) struct LaneCheckpoint {
    pub(super) samples: usize,
    /// `Σ_t e(t) e(t−k)`, `k = 0…n`.
    pub(super) autoproducts: Aligned,
    /// For each period of the plan, `F_p`.
    pub(super) folds: Vec<Aligned>,
    /// `e(N−n) … e(N−1)`, oldest first.
    pub(super) tail: Aligned,
}

impl LaneRecords {
    /// All zero, of the plan's shapes.
    pub(super) fn zeros(plan: &NoisePlan, lanes: usize) -> Self {
        let rows = |count: usize| Aligned::zeros(count * lanes);
        let checkpoint = |&samples: &usize| LaneCheckpoint {
            samples,
            autoproducts: rows(plan.lags + 1),
            folds: plan.periods.iter().map(|&period| rows(period)).collect(),
            tail: rows(plan.lags),
        };
        Self { lanes, head: rows(plan.lags), checkpoints: plan.checkpoints.iter().map(checkpoint).collect() }
    }

    /// Replicates abreast.
    pub fn lanes(&self) -> usize {
        self.lanes
    }

    /// The record of one lane.
    pub(super) fn read(&self, lane: usize, record: &mut NoiseRecord) {
        let column = |into: &mut [f64], rows: &[f64]| {
            into.iter_mut().zip(rows.chunks_exact(self.lanes)).for_each(|(into, row)| *into = row[lane]);
        };
        column(&mut record.head, &self.head);
        let mut autoproducts = vec![0.0; record.head.len() + 1];
        for (into, from) in record.checkpoints.iter_mut().zip(&self.checkpoints) {
            column(&mut into.tail, &from.tail);
            column(&mut autoproducts, &from.autoproducts);
            into.set_lag_products(&autoproducts, &record.head);
            into.folds.iter_mut().zip(&from.folds).for_each(|(into, fold)| column(into, fold));
        }
    }

    /// The rows of checkpoint `index`, and of the head, from lane `lane` on.
    pub fn view(&self, index: usize, period: usize, lane: usize) -> LaneView<'_> {
        let Self { lanes, head, checkpoints } = self;
        let LaneCheckpoint { samples, autoproducts, folds, tail } = &checkpoints[index];
        let rows = |rows| LaneRows::new(rows, *lanes, lane);
        LaneView {
            samples: *samples,
            lags: tail.len() / lanes,
            head: rows(head),
            tail: rows(tail),
            autoproducts: rows(autoproducts),
            fold: rows(&folds[period]),
        }
    }
}

/// Some lanes of a checkpoint at one period.
#[derive(Clone, Copy)]
pub struct LaneView<'a> {
    /// Samples simulated.
    pub samples: usize,
    /// Rows of the head and of the tail.
    pub lags: usize,
    /// First samples, a row a lag.
    pub head: LaneRows<'a>,
    /// Last samples, a row a lag.
    pub tail: LaneRows<'a>,
    /// Sums of lag products, a row a lag.
    pub autoproducts: LaneRows<'a>,
    /// Sums over periods, a row a phase.
    pub fold: LaneRows<'a>,
}

/// Rows of which some neighbouring lanes are read.
#[derive(Clone, Copy)]
pub struct LaneRows<'a> {
    lanes: usize,
    values: &'a [f64],
}

impl<'a> LaneRows<'a> {
    fn new(rows: &'a Aligned, lanes: usize, first: usize) -> Self {
        Self { lanes, values: &rows[first.min(rows.len())..] }
    }

    /// The next `L` lanes of a row.
    #[inline(always)]
    pub fn row<const L: usize>(self, row: usize) -> [f64; L] {
        *self.values[row * self.lanes..].first_chunk().expect("as many lanes as are read")
    }
}
