//! The hats of every sample of an input.

use super::basis::{Basis, Cell, Place};
use std::ops::Range;
use switchback_model::hysteresis::Branch;
use switchback_model::reversal::Branches;

/// One [`Cell`] a sample, sixteen bytes each: the few that lie on both branches have the second one beside them.
#[derive(Debug, Clone, Default)]
pub(super) struct Cells {
    samples: Vec<Sample>,
    /// Place on the branch that a reversal leads to, and its share of the sample.
    next: Vec<(Place, f64)>,
}

#[derive(Debug, Clone, Copy)]
struct Sample {
    weight: f64,
    knot: u32,
    /// Number in the list of the second ones, from 1; 0 where there is none.
    next: u32,
}

impl Cells {
    /// The cells of an input whose branches are known.
    pub(super) fn of(basis: &Basis, v: &[f64], branches: &Branches) -> Self {
        let labelled = v.iter().zip(branches.labels()).enumerate();
        let cell = |(t, (&v, &branch))| {
            let turned = branches.turned(t).filter(|_| basis.is_switched());
            let next = turned.map(|share| (basis.place(other(branch), v), share));
            Cell { main: basis.place(branch, v), next }
        };
        labelled.map(cell).collect()
    }

    pub(super) fn len(&self) -> usize {
        self.samples.len()
    }

    /// The cell of a sample.
    #[inline]
    pub(super) fn at(&self, t: usize) -> Cell {
        let Sample { weight, knot, next } = self.samples[t];
        let main = Place { knot: knot as usize, weight };
        Cell { main, next: next.checked_sub(1).map(|k| self.next[k as usize]) }
    }

    /// `u` over a range of samples, for knot values `f₁…`, relative to the reference knot.
    pub(super) fn values(&self, range: Range<usize>, f: &[f64]) -> Vec<f64> {
        // The reference knot has the value 0.
        let at_knots: Vec<f64> = std::iter::once(0.0).chain(f.iter().copied()).collect();
        let value = |t: usize| {
            let Sample { weight, knot, next } = self.samples[t];
            let (left, right) = (at_knots[knot as usize], at_knots[knot as usize + 1]);
            if next == 0 { (1.0 - weight) * left + weight * right } else { self.at(t).value(f) }
        };
        range.map(value).collect()
    }

    /// Adds the hats of a sample times a factor to its features.
    #[inline]
    pub(super) fn add_features(&self, t: usize, factor: f64, features: &mut [f64]) {
        let Sample { weight, knot, next } = self.samples[t];
        if next > 0 {
            self.at(t).features().for_each(|(k, x)| features[k] += factor * x);
            return;
        }
        let knot = knot as usize;
        // The reference knot has no feature.
        if knot > 0 {
            features[knot - 1] += factor * (1.0 - weight);
        }
        features[knot] += factor * weight;
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = Cell> + '_ {
        (0..self.len()).map(|t| self.at(t))
    }
}

impl FromIterator<Cell> for Cells {
    fn from_iter<I: IntoIterator<Item = Cell>>(cells: I) -> Self {
        let cells = cells.into_iter();
        let mut all = Self { samples: Vec::with_capacity(cells.size_hint().0), next: Vec::new() };
        for Cell { main, next } in cells {
            all.next.extend(next);
            let next = if next.is_some() { all.next.len() as u32 } else { 0 };
            all.samples.push(Sample { weight: main.weight, knot: main.knot as u32, next });
        }
        all
    }
}

/// The branch that a reversal leads to.
fn other(branch: Branch) -> Branch {
    match branch {
        Branch::Ascending => Branch::Descending,
        Branch::Descending => Branch::Ascending,
    }
}

const _: () = assert!(size_of::<Sample>() == 16);
