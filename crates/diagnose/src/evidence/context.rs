//! A nominal system beside the records on which it is judged.

use switchback_identify::record::{Criterion, Stretch, filter_and_project};
use switchback_model::system::{Path, Quantity, Scale, System, Term};

/// Blocks of samples over which a share of energy must repeat itself.
const BLOCKS: usize = 8;

/// Consecutive samples of one record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Block {
    pub(super) record: usize,
    pub(super) from: usize,
    pub(super) to: usize,
    /// Whether the nominal system was fitted to it.
    pub(super) is_fitted: bool,
}

/// A nominal system and all records, those that it was fitted to and others.
#[derive(Debug, Clone)]
pub(super) struct Context<'a> {
    pub(super) base: &'a System,
    pub(super) stretches: &'a [Stretch],
    /// Of the base, one a record.
    paths: Vec<Path>,
    pub(super) scale: Scale,
    pub(super) blocks: Vec<Block>,
    /// Coordinates of the base that the fit has chosen.
    pub(super) coordinates: Vec<Quantity>,
}

/// One signal, a list a record.
pub(super) type Signal = Vec<Vec<f64>>;

impl<'a> Context<'a> {
    pub(super) fn new(base: &'a System, stretches: &'a [Stretch], is_fitted: &[bool]) -> Self {
        let pairs: Vec<(&[f64], &[f64])> = stretches.iter().map(|s| (&s.v[..], &s.y[..])).collect();
        Self {
            base,
            stretches,
            paths: stretches.iter().map(|s| base.path(&s.v, s.span)).collect(),
            scale: Scale::of(&base.linear, base.rule, &pairs),
            blocks: blocks(stretches, is_fitted),
            coordinates: Quantity::coordinates(base),
        }
    }

    /// The runs of a system on all records.
    pub(super) fn runs(&self, system: &System) -> Signal {
        self.stretches.iter().zip(&self.paths).map(|(s, path)| s.simulate_beside(system, path)).collect()
    }

    /// The measured output less a run.
    pub(super) fn errors(&self, runs: &Signal) -> Signal {
        let of = |(s, run): (&Stretch, &Vec<f64>)| s.y.iter().zip(run).map(|(y, r)| y - r).collect();
        self.stretches.iter().zip(runs).map(of).collect()
    }

    /// Derivatives of the run by the coordinates of the base.
    pub(super) fn jacobian(&self, runs: &Signal) -> Vec<Signal> {
        let column = |quantity: &Quantity| {
            let step = quantity.step(self.base, &self.scale);
            let moved = quantity.set(self.base, quantity.value(self.base) + step);
            difference(&self.runs(&moved), runs, 1.0 / step)
        };
        self.coordinates.iter().map(column).collect()
    }

    /// The change of the run by a term.
    pub(super) fn change(&self, runs: &Signal, term: &Term) -> Signal {
        let mut with = self.base.clone();
        with.terms.push(term.clone());
        difference(&self.runs(&with), runs, 1.0)
    }

    /// Signals filtered by a criterion and freed of the traces of initial states.
    pub(super) fn filtered(&self, signals: &[Signal], criterion: &Criterion) -> Vec<Signal> {
        let mut out = vec![Vec::with_capacity(self.stretches.len()); signals.len()];
        for (k, stretch) in self.stretches.iter().enumerate() {
            let mut all: Vec<Vec<f64>> = signals.iter().map(|s| s[k].clone()).collect();
            filter_and_project(self.base, stretch, &mut all, criterion);
            out.iter_mut().zip(all).for_each(|(out, x)| out.push(x));
        }
        out
    }
}

/// `factor·(x − y)`; numbers that are not finite count as none.
pub(super) fn difference(x: &Signal, y: &Signal, factor: f64) -> Signal {
    let one = |(x, y): (&Vec<f64>, &Vec<f64>)| {
        x.iter().zip(y).map(|(x, y)| factor * (x - y)).map(|d| if d.is_finite() { d } else { 0.0 }).collect()
    };
    x.iter().zip(y).map(one).collect()
}

/// Pieces of much the same length, none across records.
fn blocks(stretches: &[Stretch], is_fitted: &[bool]) -> Vec<Block> {
    let total: usize = stretches.iter().map(|s| s.v.len()).sum();
    let mut all = Vec::new();
    for (record, stretch) in stretches.iter().enumerate() {
        let count = stretch.v.len();
        let pieces = (BLOCKS * count / total.max(1)).max(1);
        for k in 0..pieces {
            let (from, to) = (count * k / pieces, count * (k + 1) / pieces);
            all.push(Block { record, from, to, is_fitted: is_fitted[record] });
        }
    }
    // Without other records the last piece stands for them.
    if all.iter().all(|b| b.is_fitted)
        && let Some(last) = all.last_mut()
    {
        last.is_fitted = false;
    }
    all
}
