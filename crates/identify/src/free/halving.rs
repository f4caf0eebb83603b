//! Finer grids of knots, each of which contains the one before.

use super::basis::Basis;
use std::ops::Range;
use switchback_model::hysteresis::Branch;
use switchback_model::reversal::Branches;

/// Where an input goes on each branch: every place once, in order.
#[derive(Debug)]
pub(super) struct Places {
    descending: Vec<f64>,
    ascending: Vec<f64>,
}

/// Places of the input for every coefficient `bᵢf_k` of the regression, as `Basis::check_length` asks of samples.
const PLACES_A_COEFFICIENT: usize = 2;

impl Places {
    /// Of ranges of several inputs; a place that is visited again shows nothing new of a border's shape.
    pub(super) fn of(inputs: &[(&[f64], &Branches, Range<usize>)]) -> Self {
        let on = |wanted: Branch| {
            let visited = |(v, branches, range): &(&[f64], &Branches, Range<usize>)| {
                let samples = v[range.clone()].iter().zip(&branches.labels()[range.clone()]);
                samples.filter(|(_, branch)| **branch == wanted).map(|(v, _)| *v).collect::<Vec<_>>()
            };
            let mut places: Vec<f64> = inputs.iter().flat_map(visited).collect();
            places.sort_by(f64::total_cmp);
            places.dedup();
            places
        };
        Self { descending: on(Branch::Descending), ascending: on(Branch::Ascending) }
    }
}

impl Basis {
    /// The same two borders with every cell halved that the input visits on both halves; `None` if there is none, or if that leaves
    /// fewer than two places of the input for every coefficient of a regression whose numerator has `numerator` of them.
    pub(super) fn halved_where_visited(&self, places: &Places, numerator: usize) -> Option<Self> {
        let visited = |low: f64, high: f64, places: &[f64]| {
            places.partition_point(|&v| v <= high) > places.partition_point(|&v| v < low)
        };
        let halve = |knots: &[f64], places: &[f64]| {
            halved(knots, |low, middle, high| visited(low, middle, places) && visited(middle, high, places))
        };
        let finer = Self::borders(
            halve(self.descending(), &places.descending),
            halve(self.ascending(), &places.ascending),
        );
        let needed = PLACES_A_COEFFICIENT * numerator * finer.features();
        let known = places.descending.len() + places.ascending.len();
        (finer.features() > self.features() && needed <= known).then_some(finer)
    }

    /// The same two borders with every cell halved.
    pub(super) fn halved(&self) -> Self {
        let halve = |knots| halved(knots, |_, _, _| true);
        Self::borders(halve(self.descending()), halve(self.ascending()))
    }
}

/// Knots with the middles of the cells that are to be halved; a cell is given by its ends with its middle between.
fn halved(knots: &[f64], is_halved: impl Fn(f64, f64, f64) -> bool) -> Vec<f64> {
    let mut finer = vec![knots[0]];
    for cell in knots.windows(2) {
        let middle = 0.5 * (cell[0] + cell[1]);
        finer.extend(is_halved(cell[0], middle, cell[1]).then_some(middle));
        finer.push(cell[1]);
    }
    finer
}
