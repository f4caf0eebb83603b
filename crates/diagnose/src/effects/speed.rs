//! Which name friction has that depends on speed: that of its sign.
//!
//! ```text
//! H(r) = half + c·g(r)     half the width of the loop at speed r;   half, c from the fit, g(r) the law's function of speed
//! ```
//!
//! A law of friction that falls with speed fits one that rises as well, with a coefficient of the other sign, and conversely. Whichever
//! law fitted it: where `|H|` rises with speed it is rate dependence, where it falls Stribeck friction. The sign of `c` alone says nothing:
//! the gauge is free (`B` and the borders may both be turned over), so it is taken relative to the loop's orientation, the sign of `H` in
//! the mean.

use crate::effect::Effect;
use crate::likelihood::design::Design;
use crate::likelihood::engine::Fit;
use crate::model::augmented::{BorderColumn, Speeds};
use crate::model::borders::Grid;

/// The name of the friction that a column of the borders fitted, the one that `is_it` shows; none where there is no such
/// column, or the loop is none of friction: then the law's own name stands.
pub(super) fn of_a_column(fit: &Fit, is_it: impl Fn(&BorderColumn) -> bool) -> Option<Effect> {
    let at = fit.augmented.border_columns.iter().position(is_it)?;
    let rises = matches!(fit.augmented.border_columns[at], BorderColumn::Speed { .. });
    let coefficient = fit.linear.f[fit.grid.len() + at];
    orientation(fit).map(|orientation| named(rises, coefficient * orientation))
}

/// The name of the friction that widens the whole loop by a share.
pub(super) fn of_a_widening(speeds: Speeds, share: f64) -> Effect {
    named(speeds == Speeds::High, share)
}

/// `rises`: whether the law's function of speed does; `coefficient`: positive where it widens the loop.
fn named(rises: bool, coefficient: f64) -> Effect {
    if rises == (coefficient > 0.0) { Effect::RateDependence } else { Effect::Stribeck }
}

/// The sign of the loop: positive where the ascending border lies above, in the mean. None where `u` falls along the stroke all the same, from
/// the start of the descending border to the end of the ascending one, or conversely: such a loop lags, and no friction makes it.
fn orientation(fit: &Fit) -> Option<f64> {
    let added = mean_added(&fit.design(), fit.grid.len());
    let coefficients = &fit.linear.f[fit.grid.len()..];
    // What columns beside the tables add along the branch, in the mean over the samples in which the input moves.
    let beside: f64 = added.iter().zip(coefficients).map(|(added, c)| added * c).sum();
    let half = between_the_borders(&fit.grid, &fit.linear.f) + beside;
    let span = fit.linear.f[fit.grid.len() - 1] - fit.linear.f[0] + 2.0 * beside;
    (half * span > 0.0).then(|| half.signum())
}

/// Places along the stroke at which the borders are compared.
const PLACES: usize = 33;

fn between_the_borders(grid: &Grid, f: &[f64]) -> f64 {
    let low = grid.knots.iter().map(|knots| knots[0]).fold(f64::NEG_INFINITY, f64::max);
    let high = grid.knots.iter().map(|knots| knots[knots.len() - 1]).fold(f64::INFINITY, f64::min);
    let border = |side: usize, v: f64| grid.hat(side, v).iter().map(|(i, w)| w * f[*i]).sum::<f64>();
    let place = |k: usize| low + (high - low) * k as f64 / (PLACES - 1) as f64;
    let half = |v: f64| 0.5 * (border(1, v) - border(0, v));
    (0..PLACES).map(|k| half(place(k))).sum::<f64>() / PLACES as f64
}

/// What a unit of each column adds along the branch, in the mean over the samples in which the input moves; the borders' values are the
/// first `borders` columns of the rows.
fn mean_added(design: &Design, borders: usize) -> Vec<f64> {
    let mut sums = vec![0.0; design.augmented.border_columns.len()];
    let mut count = 0.0;
    for scaled in &design.scaled_records {
        for (t, motion) in scaled.moves.iter().enumerate().filter(|(_, motion)| motion.moves) {
            count += 1.0;
            for &(i, x) in scaled.rows.row(t) {
                if let Some(column) = (i as usize).checked_sub(borders) {
                    sums[column] += motion.branch * x;
                }
            }
        }
    }
    sums.iter().map(|sum| sum / f64::max(count, 1.0)).collect()
}
