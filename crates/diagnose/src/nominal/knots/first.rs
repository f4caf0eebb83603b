//! The first grid, and where the borders were visited.

use crate::model::borders::{Grid, side};
use crate::records::dataset::Dataset;

/// Cells of the first grid between the ends of the stroke.
const FIRST_CELLS: usize = 10;
/// Fewest samples in a cell of the first grid.
pub(super) const FEWEST: usize = 6;

/// Levels of the designed experiments, an even grid between them, and the ends; cells that a border hardly visits are
/// joined.
pub(crate) fn first_grid(dataset: &Dataset) -> Grid {
    let mut wanted: Vec<f64> = (0..=FIRST_CELLS).map(|i| i as f64 / FIRST_CELLS as f64).collect();
    let (low, high) = dataset
        .fit()
        .flat_map(|t| t.v.iter())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &v| (l.min(v), h.max(v)));
    wanted.iter_mut().for_each(|k| *k = low + (high - low) * *k);
    // A level of the experiments replaces an even knot that nearly coincides with it.
    wanted.retain(|k| dataset.levels.iter().all(|l| (l - k).abs() > 0.4 / FIRST_CELLS as f64));
    wanted.extend(&dataset.levels);
    wanted.sort_by(f64::total_cmp);
    wanted.dedup();
    let visits = visited(dataset);
    let knots = [0, 1].map(|s| {
        let mut knots: Vec<f64> = Vec::new();
        for &k in &wanted {
            let is_level = dataset.levels.contains(&k);
            let since = knots.last().copied().unwrap_or(f64::NEG_INFINITY);
            let inside = visits[s].iter().filter(|&&v| v > since && v < k).count();
            if is_level || knots.is_empty() || inside >= FEWEST || k == high {
                knots.push(k);
            }
        }
        if knots.len() < 2 { vec![low, high] } else { knots }
    });
    Grid { knots }
}

/// Positions visited on the descending and on the ascending border, fit records, sorted.
pub(super) fn visited(dataset: &Dataset) -> [Vec<f64>; 2] {
    let mut out = [Vec::new(), Vec::new()];
    for scaled in dataset.fit().filter(|t| !t.is_pulsed()) {
        for (m, v) in scaled.moves.iter().zip(&scaled.v) {
            if m.moves {
                out[side(m.branch)].push(*v);
            }
        }
    }
    out.iter_mut().for_each(|v| v.sort_by(f64::total_cmp));
    out
}
