//! Border knots placed from the data.

use crate::assembly::convolve;
use crate::borders::{Grid, side};
use crate::campaign::Campaign;
use crate::design::{Design, Whitener};
use crate::engine::{Build, Fit, Ground, fit, priors};
use crate::gains::{Gains, Scored};
use crate::jacobian::{Jacobian, normal_equations};
use crate::motion::Motion;

/// Cells of the first grid between the ends of the stroke.
const FIRST_CELLS: usize = 10;
/// Fewest samples in a cell of the first grid.
const FEWEST: usize = 6;
/// Gain in deviance that a new knot must bring: two parameters and the search over its place among N samples.
const KNOT_GAIN: f64 = 30.0;
/// Knots of one border never exceed this.
const MOST: usize = 48;
/// Cells looked at in one round.
const CELLS: usize = 10;
/// Rounds of refinement.
const ROUNDS: usize = 4;
/// Moves of the jumps after each round.
const POLISHES: usize = 3;
/// Gain in deviance below which an added knot is taken out again.
const WORTH: f64 = 16.0;

/// Levels of the designed experiments, an even grid between them, and the ends; cells that a border hardly visits are
/// joined.
pub(crate) fn first_grid(campaign: &Campaign) -> Grid {
    let mut wanted: Vec<f64> = (0..=FIRST_CELLS).map(|i| i as f64 / FIRST_CELLS as f64).collect();
    let (low, high) = campaign
        .fit()
        .flat_map(|t| t.v.iter())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &v| (l.min(v), h.max(v)));
    wanted.iter_mut().for_each(|k| *k = low + (high - low) * *k);
    // A level of the experiments replaces an even knot that nearly coincides with it.
    wanted.retain(|k| campaign.levels.iter().all(|l| (l - k).abs() > 0.4 / FIRST_CELLS as f64));
    wanted.extend(&campaign.levels);
    wanted.sort_by(f64::total_cmp);
    wanted.dedup();
    let visits = visited(campaign);
    let knots = [0, 1].map(|s| {
        let mut knots: Vec<f64> = Vec::new();
        for &k in &wanted {
            let is_level = campaign.levels.contains(&k);
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
fn visited(campaign: &Campaign) -> [Vec<f64>; 2] {
    let mut out = [Vec::new(), Vec::new()];
    for track in campaign.fit().filter(|t| !t.is_pulsed()) {
        for (m, v) in track.moves.iter().zip(&track.v) {
            if m.moves {
                out[side(m.branch)].push(*v);
            }
        }
    }
    out.iter_mut().for_each(|v| v.sort_by(f64::total_cmp));
    out
}

/// A place where a border seems to bend or jump.
struct Place {
    side: usize,
    v: f64,
    strength: f64,
}

/// Adds knots and jumps while the data ask for them.
pub(crate) fn refine(campaign: &Campaign, mut best: Fit, build: &Build<'_>) -> Fit {
    for _ in 0..ROUNDS {
        let Some(grid) = improved_grid(campaign, &best) else { break };
        let next = refitted(campaign, &best, &grid, build).and_then(|f| polished(campaign, f, build));
        let Some(next) = next else { break };
        if next.deviance > best.deviance - 0.5 * KNOT_GAIN {
            break;
        }
        best = next;
    }
    let placed = collapsed(campaign, pruned(campaign, best, build), build);
    halved(campaign, placed, build)
}

/// The model on an even grid through the levels of the experiments, as fine as smooth borders ask for: no knot is placed to
/// follow a detail.
pub(crate) fn evenly(campaign: &Campaign, fitted: &Fit, build: &Build<'_>) -> Option<Fit> {
    let fit = refitted(campaign, fitted, &first_grid(campaign), build)?;
    Some(halved(campaign, fit, build))
}

/// Gain in deviance per knot that an evenly finer grid must bring: smooth borders spread their gain over all cells.
const HALVING_GAIN: f64 = 9.5;
/// Cells narrower than this are not halved, in strokes.
const FINEST: f64 = 0.03;

/// The grid with its cells halved, as long as that pays.
fn halved(campaign: &Campaign, mut best: Fit, build: &Build<'_>) -> Fit {
    let visits = visited(campaign);
    for _ in 0..2 {
        let mut grid = best.grid.clone();
        for s in 0..2 {
            for cell in best.grid.knots[s].windows(2) {
                let inside = visits[s].iter().filter(|v| **v > cell[0] && **v < cell[1]).count();
                if cell[1] - cell[0] > FINEST && inside >= 3 * FEWEST {
                    grid.insert(s, 0.5 * (cell[0] + cell[1]), false);
                }
            }
        }
        let added = (grid.len() - best.grid.len()) as f64;
        match refitted(campaign, &best, &grid, build) {
            Some(f) if added > 0.0 && f.deviance < best.deviance - HALVING_GAIN * added => best = f,
            _ => break,
        }
    }
    best
}

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

/// Jumps moved until they rest.
fn polished(campaign: &Campaign, mut fitted: Fit, build: &Build<'_>) -> Option<Fit> {
    for _ in 0..POLISHES {
        let Some(moved) = moved_jumps(campaign, &fitted) else { break };
        match refitted(campaign, &fitted, &moved, build) {
            Some(f) if f.deviance < fitted.deviance - 1.0 => fitted = f,
            _ => break,
        }
    }
    Some(fitted)
}

/// Width of the cell that stands for a jump beside a level, in strokes.
const TOUCHING: f64 = 1e-7;

/// Narrow cells replaced by jumps where that fits no worse: a jump found in two steps leaves a steep cell.
fn collapsed(campaign: &Campaign, mut best: Fit, build: &Build<'_>) -> Fit {
    for s in 0..2 {
        let mut i = 0;
        while i + 1 < best.grid.knots[s].len() {
            let (l, r) = (best.grid.knots[s][i], best.grid.knots[s][i + 1]);
            i += 1;
            if r - l <= 2.0 * TOUCHING || !(r - l <= NARROW || is_steep(&best, s, i - 1)) {
                continue;
            }
            let is_level = [l, r].map(|k| campaign.levels.contains(&k));
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
                looked_at(campaign, &best, &grid, build)
            });
            let next = trials
                .min_by(|x, y| cost(x).total_cmp(&cost(y)))
                .filter(|next| cost(next) < cost(&best) + HOPEFUL)
                .and_then(|next| polished(campaign, refitted(campaign, &next, &next.grid, build)?, build));
            if let Some(next) = next
                && cost(&next) < cost(&best) + 4.0
            {
                best = next;
            }
        }
    }
    best
}

/// Knots placed anew from the first grid: those found with an effect missing from the model followed its trace.
pub(crate) fn replace(campaign: &Campaign, fitted: &Fit, build: &Build<'_>) -> Fit {
    let fresh = refitted(campaign, fitted, &first_grid(campaign), build).map(|f| refine(campaign, f, build));
    let bic = |f: &Fit| f.deviance + f.parameters * (f.samples as f64).ln();
    match fresh {
        Some(f) if bic(&f) < bic(fitted) => f,
        _ => refine(campaign, fitted.clone(), build),
    }
}

/// The same model re-fitted on another grid.
fn refitted(campaign: &Campaign, fitted: &Fit, grid: &Grid, build: &Build<'_>) -> Option<Fit> {
    let start = carried_over(fitted, grid);
    let known = Some(&*fitted.design);
    fit(Ground { campaign, grid, known }, build, &fitted.own, &start, 5)
}

/// The same model on another grid, one step from the present parameters.
fn looked_at(campaign: &Campaign, fitted: &Fit, grid: &Grid, build: &Build<'_>) -> Option<Fit> {
    let known = Some(&*fitted.design);
    fit(Ground { campaign, grid, known }, build, &fitted.own, &carried_over(fitted, grid), 1)
}

/// Jumps moved to where the neighbouring samples want them; nothing where none should move.
fn moved_jumps(campaign: &Campaign, best: &Fit) -> Option<Grid> {
    let design = Design::like(Some(&best.design), campaign, &best.grid, &best.assembly);
    let whitener = design.whitener(&best.assembly.noise, &best.linear.a);
    let innovations = design.innovations(&best.linear, &whitener);
    let visits = visited(campaign);
    let mut trials: Vec<(usize, f64, f64)> = Vec::new();
    for s in 0..2 {
        for pair in best.grid.knots[s].windows(2).filter(|w| w[0] == w[1]) {
            let here = visits[s].partition_point(|&v| v < pair[0]) as isize;
            for offset in [-60, -35, -20, -12, -8, -5, -3, -2, -1, 1, 2, 3, 5, 8, 12, 20, 35, 60] {
                let at = here + offset;
                if at < 1 || at as usize >= visits[s].len() {
                    continue;
                }
                let to = 0.5 * (visits[s][at as usize - 1] + visits[s][at as usize]);
                let crossed = |k: &f64| *k != pair[0] && (*k - pair[0]) * (*k - to) <= 0.0;
                if to != pair[0] && !best.grid.knots[s].iter().any(crossed) {
                    trials.push((s, pair[0], to));
                }
            }
        }
    }
    if trials.is_empty() {
        return None;
    }
    let jacobian = Jacobian::new(&design, &best.linear, &whitener, None);
    let innovations = innovations.concat();
    let gains = Gains::new(&jacobian, &innovations, best.variance / design.criterion.share())?;
    let scored: Vec<Scored> = trials
        .iter()
        .map(|&(s, from, to)| {
            let (low, high) = (from.min(to), from.max(to));
            let step = |v| f64::from(u8::from(v > low && v <= high));
            gains.score(column(campaign, best, &design, &whitener, s, step))
        })
        .collect();
    let mut grid = best.grid.clone();
    let mut changed = false;
    for group in trials.chunk_by(|x, y| x.0 == y.0 && x.1 == y.1) {
        let first = trials.iter().position(|t| t == &group[0]).unwrap_or(0);
        let best_of = (0..group.len())
            .map(|i| (gains.of(&[&scored[first + i]]), group[i]))
            .max_by(|x, y| x.0.total_cmp(&y.0));
        if let Some((gain, (s, from, to))) = best_of
            && gain > 6.0
        {
            grid.knots[s].iter_mut().filter(|k| **k == from).for_each(|k| *k = to);
            changed = true;
        }
    }
    // Two jumps may have moved past each other.
    grid.knots.iter_mut().for_each(|k| k.sort_by(f64::total_cmp));
    changed.then_some(grid)
}

/// Without the knots and jumps that earn less than they cost.
fn pruned(campaign: &Campaign, best: Fit, build: &Build<'_>) -> Fit {
    let first = first_grid(campaign);
    let design = Design::like(Some(&best.design), campaign, &best.grid, &best.assembly);
    let whitener = design.whitener(&best.assembly.noise, &best.linear.a);
    let innovations = design.innovations(&best.linear, &whitener);
    let mut normal = normal_equations(&design, &best.linear, &whitener, None, (&innovations.concat(), &[]));
    // Without the gauge no border value would be determined.
    priors(&mut normal, &best.grid, &best.linear, &best.assembly);
    let Some(factor) = normal.factor(1e-9) else { return best };
    let base = best.linear.a.len() + best.linear.b.len();
    let mut grid = best.grid.clone();
    let mut offset = base;
    for s in 0..2 {
        let knots = &best.grid.knots[s];
        let mut keep = vec![true; knots.len()];
        let mut touched = usize::MAX;
        for i in 1..knots.len() - 1 {
            let added = !first.knots[s].contains(&knots[i]) || knots[i - 1] == knots[i];
            if !added || touched == i - 1 {
                continue;
            }
            // The contrast that removing knot i would set to zero.
            let (l, r) = (knots[i] - knots[i - 1], knots[i + 1] - knots[i]);
            let terms: Vec<(usize, f64)> = if l == 0.0 || r == 0.0 {
                let other = if l == 0.0 { i - 1 } else { i + 1 };
                vec![(i, 1.0), (other, -1.0)]
            } else {
                vec![(i - 1, r / (l + r)), (i, -1.0), (i + 1, l / (l + r))]
            };
            let mut c = vec![0.0; normal.size];
            terms.iter().for_each(|&(k, x)| c[offset + k] = x);
            let value: f64 = terms.iter().map(|&(k, x)| x * best.linear.f[offset - base + k]).sum();
            let spread: f64 = factor.solve(&c).iter().zip(&c).map(|(x, y)| x * y).sum::<f64>()
                * best.variance
                / design.criterion.share();
            if value * value < WORTH * spread {
                keep[i] = false;
                touched = i;
            }
        }
        let mut kept = keep.iter();
        grid.knots[s].retain(|_| *kept.next().unwrap_or(&true));
        offset += knots.len();
    }
    if grid == best.grid {
        return best;
    }
    let price = (best.samples as f64).ln();
    let cost = |f: &Fit| f.deviance + price * f.grid.len() as f64;
    match refitted(campaign, &best, &grid, build) {
        Some(f) if cost(&f) < cost(&best) => f,
        _ => best,
    }
}

/// The linear parameters on a finer grid: the same borders.
pub(crate) fn carried_over(fit: &Fit, grid: &Grid) -> crate::design::Linear {
    let mut p = fit.linear.clone();
    let old = fit.grid.len();
    let mut f = Vec::with_capacity(grid.len() + p.f.len() - old);
    for s in 0..2 {
        let knots = &grid.knots[s];
        for (i, &v) in knots.iter().enumerate() {
            // The right end of a jump takes the value just above it.
            let at = if i > 0 && knots[i - 1] == v { v + 1e-9 } else { v };
            f.push(fit.grid.hat(s, at).iter().map(|&(j, w)| w * p.f[j]).sum());
        }
    }
    f.extend(&p.f[old..]);
    p.f = f;
    p
}

/// A finer grid, or nothing where no knot is worth its cost.
fn improved_grid(campaign: &Campaign, best: &Fit) -> Option<Grid> {
    let design = Design::like(Some(&best.design), campaign, &best.grid, &best.assembly);
    let whitener = design.whitener(&best.assembly.noise, &best.linear.a);
    let innovations = design.innovations(&best.linear, &whitener);
    let mut places = suspicious(campaign, best, &design, &innovations);
    places.sort_by(|x, y| y.strength.total_cmp(&x.strength));
    places.truncate(CELLS);
    if places.is_empty() {
        return None;
    }
    let jacobian = Jacobian::new(&design, &best.linear, &whitener, None);
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
            gains.score(column(campaign, best, &design, &whitener, place.side, shape))
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
fn suspicious(campaign: &Campaign, best: &Fit, design: &Design, innovations: &[Vec<f64>]) -> Vec<Place> {
    let b = convolve(&best.linear.b, &design.taps);
    let mut visits: [Vec<(f64, f64)>; 2] = [Vec::new(), Vec::new()];
    for ((track, part), w) in campaign.fit().zip(&design.tracks).zip(innovations) {
        let at = |t: usize| if t >= part.from && t < track.v.len() { w[t - part.from] } else { 0.0 };
        let mut current: Option<usize> = None;
        for (t, m) in part.moves.iter().enumerate() {
            if m.moves {
                visits[side(m.branch)].push((track.v[t], 0.0));
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
fn column(
    campaign: &Campaign,
    best: &Fit,
    design: &Design,
    whitener: &Whitener,
    border: usize,
    shape: impl Fn(f64) -> f64,
) -> Vec<f64> {
    let b = convolve(&best.linear.b, &design.taps);
    let mut out = Vec::with_capacity(design.samples());
    for (track, part) in campaign.fit().zip(&design.tracks) {
        let mut now = 0.0;
        let at = |(m, v): (&Motion, &f64)| {
            if m.moves {
                now = if side(m.branch) == border { shape(*v) } else { 0.0 };
            }
            now
        };
        let g: Vec<f64> = part.moves.iter().zip(&track.v).map(at).collect();
        out.extend(whitener.column(&g, &b, part.from));
    }
    out
}
