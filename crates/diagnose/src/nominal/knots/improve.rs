//! Knots and jumps that the residual asks for.

use super::FEWEST;
use crate::likelihood::design::{Design, Whitener};
use crate::likelihood::engine::Fit;
use crate::likelihood::gains::Gains;
use crate::likelihood::jacobian::Jacobian;
use crate::likelihood::weights::Weights;
use crate::model::augmented::convolve;
use crate::model::borders::{Grid, side};
use crate::records::dataset::Dataset;
use crate::records::motion::Motion;

/// Gain in deviance that a new knot must bring: two parameters and the search over its place among N samples.
pub(super) const KNOT_GAIN: f64 = 30.0;
/// Knots of one border never exceed this.
const MOST: usize = 48;
/// Cells looked at in one round.
const CELLS: usize = 10;

/// A place where a border seems to bend or jump.
struct Place {
    side: usize,
    v: f64,
    strength: f64,
}

/// A finer grid, or nothing where no knot is worth its cost.
pub(super) fn improved_grid(dataset: &Dataset, best: &Fit) -> Option<Grid> {
    let design = Design::like(Some(best.near()), dataset, &best.grid, &best.augmented);
    let whitener = design.whitener(&best.augmented.noise, &best.linear.a);
    let innovations = design.counted_innovations(&best.linear, &whitener);
    let mut places = suspicious(dataset, best, &design, &innovations);
    places.sort_by(|x, y| y.strength.total_cmp(&x.strength));
    places.truncate(CELLS);
    if places.is_empty() {
        return None;
    }
    let jacobian = Jacobian::new(&design, &best.linear, &whitener, &Weights::default());
    let innovations = innovations.concat();
    let gains = Gains::new(&jacobian, &innovations, best.variance / design.criterion.share())?;
    let mut grid = best.grid.clone();
    let mut changed = false;
    for place in &places {
        if grid.knots[place.side].len() + 2 > MOST {
            continue;
        }
        let at = place.v;
        let of_shape = |shape: &dyn Fn(f64) -> f64| {
            gains.score(column(dataset, best, &design, &whitener, place.side, shape))
        };
        let bend = of_shape(&|v| (v - at).max(0.0));
        let step = of_shape(&|v| f64::from(u8::from(v > at)));
        let (bend, both) = (gains.of(&[&bend]), gains.of(&[&step, &bend]));
        if both > bend + 12.0 && both > KNOT_GAIN + 8.0 {
            changed |= grid.insert(place.side, place.v, true);
        } else if bend > KNOT_GAIN {
            changed |= grid.insert(place.side, place.v, false);
        }
    }
    changed.then_some(grid)
}

/// In each cell, the place where the cumulated sensitivity of the residual peaks.
fn suspicious(dataset: &Dataset, best: &Fit, design: &Design, innovations: &[Vec<f64>]) -> Vec<Place> {
    let b = convolve(&best.linear.b, &design.taps);
    let mut visits: [Vec<(f64, f64)>; 2] = [Vec::new(), Vec::new()];
    for ((scaled, effect_term), w) in dataset.fit().zip(&design.scaled_records).zip(innovations) {
        let at = |t: usize| {
            if t >= effect_term.from && t < scaled.v.len() { w[t - effect_term.from] } else { 0.0 }
        };
        let mut current: Option<usize> = None;
        for (t, m) in effect_term.moves.iter().enumerate() {
            if m.moves {
                visits[side(m.branch)].push((scaled.v[t], 0.0));
                current = Some(side(m.branch));
            }
            // While the input rests, u stays where the last move put it.
            if let Some(s) = current
                && let Some(last) = visits[s].last_mut()
            {
                last.1 += b.iter().enumerate().map(|(j, b)| b * at(t + j + 1)).sum::<f64>();
            }
        }
    }
    let mut places = Vec::new();
    for s in 0..2 {
        visits[s].sort_by(|x, y| x.0.total_cmp(&y.0));
        let knots = &best.grid.knots[s];
        for cell in knots.windows(2) {
            let inside: Vec<&(f64, f64)> =
                visits[s].iter().filter(|x| x.0 > cell[0] && x.0 < cell[1]).collect();
            if inside.len() < FEWEST {
                continue;
            }
            let mut sum = 0.0;
            let mut peak = (0.0_f64, 0);
            for (i, x) in inside.iter().enumerate().take(inside.len() - 2) {
                sum += x.1;
                if i >= 1 && sum.abs() > peak.0.abs() && inside[i + 1].0 > x.0 {
                    peak = (sum, i);
                }
            }
            if peak.0 != 0.0 {
                let v = 0.5 * (inside[peak.1].0 + inside[peak.1 + 1].0);
                if (v - cell[0]).min(cell[1] - v) > 1e-4 {
                    let strength = peak.0 * peak.0 / inside.len() as f64;
                    places.push(Place { side: s, v, strength });
                }
            }
        }
    }
    places
}

/// The derivative of the innovations with respect to a change `shape(v)` of a border.
pub(super) fn column(
    dataset: &Dataset,
    best: &Fit,
    design: &Design,
    whitener: &Whitener,
    border: usize,
    shape: impl Fn(f64) -> f64,
) -> Vec<f64> {
    let b = convolve(&best.linear.b, &design.taps);
    let mut out = Vec::with_capacity(design.samples());
    for (scaled, effect_term) in dataset.fit().zip(&design.scaled_records) {
        let mut now = 0.0;
        let at = |(m, v): (&Motion, &f64)| {
            if m.moves {
                now = if side(m.branch) == border { shape(*v) } else { 0.0 };
            }
            now
        };
        let g: Vec<f64> = effect_term.moves.iter().zip(&scaled.v).map(at).collect();
        out.extend(whitener.column(&g, &b, effect_term.from));
    }
    out
}
