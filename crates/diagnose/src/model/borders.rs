//! Two tabulated borders, linear between knots, with jumps where a knot stands twice.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::records::motion::Play;

/// Knots of both borders on the dimensionless input axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Grid {
    /// Descending border, then ascending border; each non-decreasing, a repeated knot is a jump.
    pub(crate) knots: [Vec<f64>; 2],
}

/// Index of a border in [`Grid::knots`] by branch.
pub(crate) fn side(branch: f64) -> usize {
    usize::from(branch > 0.0)
}

impl Grid {
    /// The grid of the recorded input where the operator's own lies behind a play.
    pub(crate) fn seen_through(&self, play: Play) -> Self {
        let [descending, ascending] = &self.knots;
        let seen = |knots: &[f64], branch| knots.iter().map(|k| play.input_at(*k, branch)).collect();
        Self { knots: [seen(descending, -1.0), seen(ascending, 1.0)] }
    }

    /// Number of border values of both borders together.
    pub(crate) fn len(&self) -> usize {
        self.knots[0].len() + self.knots[1].len()
    }

    /// Where a border jumps.
    pub(crate) fn jumps(&self, side: usize) -> impl Iterator<Item = f64> {
        self.knots[side].windows(2).filter(|w| w[0] == w[1]).map(|w| w[0])
    }

    /// The two border values that carry `v` on a border, with their weights (linear interpolation; constant outside).
    pub(crate) fn hat(&self, side: usize, v: f64) -> [(usize, f64); 2] {
        self.hat_before(side, self.knots[side].partition_point(|&k| k < v), v)
    }

    /// The same, given the first knot not below `v`: a value on a jump belongs to its left end.
    fn hat_before(&self, side: usize, right: usize, v: f64) -> [(usize, f64); 2] {
        let knots = &self.knots[side];
        let offset = side * self.knots[0].len();
        let last = knots.len() - 1;
        if right == 0 {
            return [(offset, 1.0), (offset, 0.0)];
        }
        if right > last {
            return [(offset + last, 1.0), (offset + last, 0.0)];
        }
        let (l, r) = (knots[right - 1], knots[right]);
        let w = if r > l { (v - l) / (r - l) } else { 0.0 };
        [(offset + right - 1, 1.0 - w), (offset + right, w)]
    }

    /// Adds a knot; `jump` adds it twice. Returns whether anything changed.
    pub(crate) fn insert(&mut self, side: usize, v: f64, jump: bool) -> bool {
        let knots = &mut self.knots[side];
        let at = knots.partition_point(|&k| k < v);
        let present = knots[at..].iter().take_while(|&&k| k == v).count();
        let wanted = if jump { 2 } else { 1 };
        for _ in present..wanted {
            knots.insert(at, v);
        }
        present < wanted
    }
}

/// Finds cells of a grid by a table of its axis.
pub(crate) struct Finder<'a> {
    grid: &'a Grid,
    /// Of each border: the lower end, entries a unit, and how many knots lie below each entry's place.
    tables: [(f64, f64, Vec<u32>); 2],
}

/// Entries of a finder's table.
const ENTRIES: usize = 256;

impl<'a> Finder<'a> {
    pub(crate) fn new(grid: &'a Grid) -> Self {
        let table = |knots: &Vec<f64>| {
            let (low, high) = (knots[0], knots[knots.len() - 1]);
            let scale = ENTRIES as f64 / (high - low).max(f64::MIN_POSITIVE);
            let mut below = 0;
            let entry = |i| {
                let place = low + i as f64 / scale;
                while below < knots.len() && knots[below] < place {
                    below += 1;
                }
                below as u32
            };
            (low, scale, (0..=ENTRIES).map(entry).collect())
        };
        Self { grid, tables: [table(&grid.knots[0]), table(&grid.knots[1])] }
    }

    /// [`Grid::hat`].
    pub(crate) fn hat(&self, side: usize, v: f64) -> [(usize, f64); 2] {
        let knots = &self.grid.knots[side];
        let (low, scale, table) = &self.tables[side];
        let mut right = table[(((v - low) * scale) as usize).min(ENTRIES)] as usize;
        while right < knots.len() && knots[right] < v {
            right += 1;
        }
        // Rounding may have put v an entry too high.
        while right > 0 && knots[right - 1] >= v {
            right -= 1;
        }
        self.grid.hat_before(side, right, v)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn the_table_finds_what_a_search_does(
            mut knots in prop::collection::vec(-0.5..1.5_f64, 2..30),
            at in prop::collection::vec(-1.0..2.0_f64, 50),
        ) {
            knots.sort_by(f64::total_cmp);
            knots.insert(1, knots[0]);
            let grid = Grid { knots: [knots.clone(), vec![0.0, 1.0]] };
            let finder = Finder::new(&grid);
            for v in at.iter().chain(&knots) {
                for side in 0..2 {
                    prop_assert_eq!(finder.hat(side, *v), grid.hat(side, *v));
                }
            }
        }
    }
}
