//! Jumps: where cells collapse to one, and where one moves to.

use super::model::{Model, carried_over};
use super::passages::Steps;
use crate::likelihood::design::Design;
use crate::likelihood::engine::{Fit, FitContext, fit};
use crate::likelihood::gains::Gains;
use crate::likelihood::jacobian::Jacobian;
use crate::likelihood::weights::Weights;
use crate::model::borders::Grid;

/// Moves of the jumps after each round.
const POLISHES: usize = 3;
/// A cell narrower than this may be a jump, in strokes.
const NARROW: f64 = 0.008;

/// Whether a cell up to [`WIDE`] rises or falls much faster than its border does elsewhere.
fn is_steep(fit: &Fit, s: usize, cell: usize) -> bool {
    let knots = &fit.grid.knots[s];
    let offset = s * fit.grid.knots[0].len();
    let slope = |i: usize| {
        let width = knots[i + 1] - knots[i];
        (width > 2.0 * TOUCHING)
            .then(|| ((fit.linear.f[offset + i + 1] - fit.linear.f[offset + i]) / width).abs())
    };
    let mut slopes: Vec<f64> = (0..knots.len() - 1).filter_map(slope).collect();
    slopes.sort_by(f64::total_cmp);
    let median = slopes[slopes.len() / 2];
    knots[cell + 1] - knots[cell] < WIDE && slope(cell).is_some_and(|x| x > 3.0 * median)
}

/// A jump that costs no more than this before it is moved may pay after.
const HOPEFUL: f64 = 200.0;
/// A cell wider than this is no candidate for a jump, in strokes.
const WIDE: f64 = 0.12;

/// Width of the cell that stands for a jump beside a level, in strokes.
const TOUCHING: f64 = 1e-7;

/// Narrow cells replaced by jumps where that fits no worse: a jump found in two steps leaves a steep cell.
pub(super) fn collapsed(model: &Model<'_>, mut best: Fit) -> Fit {
    let dataset = model.dataset;
    for s in 0..2 {
        let mut i = 0;
        while i + 1 < best.grid.knots[s].len() {
            let (l, r) = (best.grid.knots[s][i], best.grid.knots[s][i + 1]);
            i += 1;
            if r - l <= 2.0 * TOUCHING || !(r - l <= NARROW || is_steep(&best, s, i - 1)) {
                continue;
            }
            let is_level = [l, r].map(|k| dataset.levels.contains(&k));
            let inner = [0.5 * (l + r), l + 1e-4, r - 1e-4];
            let beside = [is_level[1].then_some(r - TOUCHING), is_level[0].then_some(l + TOUCHING)];
            let options = inner.into_iter().filter(|x| *x > l && *x < r).chain(beside.into_iter().flatten());
            let price = (best.samples as f64).ln();
            let cost = |f: &Fit| f.deviance + price * f.grid.len() as f64;
            let trials = options.filter_map(|jump| {
                let mut grid = best.grid.clone();
                // A level of the experiments keeps its own value.
                grid.knots[s].retain(|k| (*k != l || is_level[0]) && (*k != r || is_level[1]));
                let beside_level = beside.contains(&Some(jump));
                grid.insert(s, jump, !beside_level);
                looked_at(model, &best, &grid)
            });
            let next = trials
                .min_by(|x, y| cost(x).total_cmp(&cost(y)))
                .filter(|next| cost(next) < cost(&best) + HOPEFUL)
                .and_then(|next| polished(model, model.refitted(&next, &next.grid)?));
            if let Some(next) = next
                && cost(&next) < cost(&best) + 4.0
            {
                best = next;
            }
        }
    }
    best
}

/// Jumps moved until they rest.
pub(super) fn polished(model: &Model<'_>, mut fitted: Fit) -> Option<Fit> {
    for _ in 0..POLISHES {
        let Some(moved) = moved_jumps(model, &fitted) else { break };
        match model.refitted(&fitted, &moved) {
            Some(f) if f.deviance < fitted.deviance - 1.0 => fitted = f,
            _ => break,
        }
    }
    Some(fitted)
}

/// The same model on another grid, one step from the present parameters.
fn looked_at(model: &Model<'_>, fitted: &Fit, grid: &Grid) -> Option<Fit> {
    let known = Some(&**fitted.near());
    fit(
        FitContext { dataset: model.dataset, grid, known },
        model.build,
        &fitted.nonlinear,
        &carried_over(fitted, grid),
        1,
    )
}

/// Visits by which a jump is moved at a time.
const BY: [usize; 9] = [1, 2, 3, 5, 8, 12, 20, 35, 60];

/// Jumps moved to where the neighbouring samples want them; nothing where none should move.
fn moved_jumps(model: &Model<'_>, best: &Fit) -> Option<Grid> {
    if (0..2).all(|s| best.grid.jumps(s).next().is_none()) {
        return None;
    }
    let design = Design::like(Some(best.near()), model.dataset, &best.grid, &best.augmented);
    let whitener = design.whitener(&best.augmented.noise, &best.linear.a);
    let innovations = design.counted_innovations(&best.linear, &whitener).concat();
    let jacobian = Jacobian::new(&design, &best.linear, &whitener, &Weights::default());
    let gains = Gains::new(&jacobian, &innovations, best.variance / design.criterion.share())?;
    let mut steps = Steps::new(&gains, &design, best);
    let mut grid = best.grid.clone();
    let mut changed = false;
    for s in 0..2 {
        let knots = &best.grid.knots[s];
        for from in best.grid.jumps(s) {
            let found = [false, true].into_iter().filter_map(|up| {
                // No further than the next knot.
                let beyond = |k: &&f64| if up { **k > from } else { **k < from };
                let ahead = knots.iter().filter(beyond);
                let limit = if up {
                    ahead.min_by(|a, b| a.total_cmp(b))
                } else {
                    ahead.max_by(|a, b| a.total_cmp(b))
                };
                steps.clear();
                let mut best_of: Option<(f64, f64)> = None;
                let mut at = from;
                for to in model.passages.places(s, from, up, &BY) {
                    if limit.is_some_and(|k| (*k - from) * (*k - to) <= 0.0) {
                        break;
                    }
                    steps.add(model.passages.between(s, at, to));
                    at = to;
                    let gain = steps.gain();
                    if best_of.is_none_or(|b| gain > b.0) {
                        best_of = Some((gain, to));
                    }
                }
                best_of
            });
            if let Some((gain, to)) = found.max_by(|x, y| x.0.total_cmp(&y.0))
                && gain > 6.0
            {
                grid.knots[s].iter_mut().filter(|k| **k == from).for_each(|k| *k = to);
                changed = true;
            }
        }
    }
    // Two jumps may have moved past each other.
    grid.knots.iter_mut().for_each(|k| k.sort_by(f64::total_cmp));
    changed.then_some(grid)
}
