//! Border knots placed from the data.

mod first;
mod improve;
mod jumps;
mod model;
mod passages;
mod prune;
mod rough;

pub(crate) use self::first::first_grid;
use self::first::{FEWEST, visited};
use self::improve::{KNOT_GAIN, improved_grid};
use self::jumps::{collapsed, polished};
pub(crate) use self::model::carried_over;
use self::model::{Model, refitted};
use self::passages::Passages;
use self::prune::pruned;
use self::rough::roughness;
use crate::likelihood::engine::{Build, Fit};
use crate::records::dataset::Dataset;

/// Rounds of refinement.
const ROUNDS: usize = 4;

/// Adds knots and jumps while the data ask for them.
pub(crate) fn refine(dataset: &Dataset, mut best: Fit, build: &Build<'_>) -> Fit {
    let passages = Passages::new(dataset, &best.design());
    let model = Model { dataset, build, passages: &passages };
    for _ in 0..ROUNDS {
        let Some(grid) = improved_grid(dataset, &best) else { break };
        let next = model.refitted(&best, &grid).and_then(|f| polished(&model, f));
        let Some(next) = next else { break };
        if next.deviance > best.deviance - 0.5 * KNOT_GAIN {
            break;
        }
        best = next;
    }
    let placed = collapsed(&model, pruned(&model, best));
    halved(dataset, placed, build)
}

/// The model on an even grid through the levels of the experiments, as fine as pays: no knot is placed to follow a refinement.
pub(crate) fn evenly(dataset: &Dataset, fitted: &Fit, build: &Build<'_>) -> Option<Fit> {
    Some(halved(dataset, on_first_grid(dataset, fitted, build)?, build))
}

/// Penalised deviance that refinements of the borders must be worth before the grid counts as too coarse: a tenth a sample, which is a
/// third of the noise's standard deviation. No grid is fine enough for every border, and knots that follow a bend or a small jump are
/// the border's own.
pub(crate) fn refinement(dataset: &Dataset) -> f64 {
    0.1 * dataset.fit_samples() as f64
}

/// Share of what a finer even grid gains, predicted by no smooth curve, from which it follows a refinement.
const ROUGH: f64 = 1.0 / 3.0;

/// The same, as fine as smooth borders ask for: a finer grid may follow a refinement all along the borders.
pub(crate) fn smoothly(dataset: &Dataset, fitted: &Fit, build: &Build<'_>) -> Option<Fit> {
    let first = on_first_grid(dataset, fitted, build)?;
    let fine = halved(dataset, first.clone(), build);
    let innovation_share = roughness(&first.grid, &fine.grid, &fine.linear.f);
    let is_refinement = innovation_share * (first.deviance - fine.deviance) > refinement(dataset);
    Some(if innovation_share > ROUGH && is_refinement { first } else { fine })
}

/// The first grid, with the jumps found where no experiment has set levels: a border may be discontinuous (Rochdi et al. 2009,
/// Assumption 1), and only where it is tabulated at levels can a jump between them be finer than the table.
fn on_first_grid(dataset: &Dataset, fitted: &Fit, build: &Build<'_>) -> Option<Fit> {
    let mut grid = first_grid(dataset);
    if dataset.levels.is_empty() {
        for side in 0..2 {
            for jump in fitted.grid.jumps(side) {
                grid.insert(side, jump, true);
            }
        }
    }
    refitted(dataset, fitted, &grid, build)
}

/// Gain in deviance per knot that an evenly finer grid must bring: smooth borders spread their gain over all cells.
const HALVING_GAIN: f64 = 9.5;
/// Cells narrower than this are not halved, in strokes.
const FINEST: f64 = 0.03;

/// The grid with its cells halved, as long as that pays.
fn halved(dataset: &Dataset, mut best: Fit, build: &Build<'_>) -> Fit {
    let visits = visited(dataset);
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
        match refitted(dataset, &best, &grid, build) {
            Some(f) if added > 0.0 && f.deviance < best.deviance - HALVING_GAIN * added => best = f,
            _ => break,
        }
    }
    best
}

/// Knots placed anew from the first grid: those found with an effect missing from the model followed its trace.
pub(crate) fn replace(dataset: &Dataset, fitted: &Fit, build: &Build<'_>) -> Fit {
    let fresh = refitted(dataset, fitted, &first_grid(dataset), build).map(|f| refine(dataset, f, build));
    let bic = |f: &Fit| f.deviance + f.parameters * (f.samples as f64).ln();
    match fresh {
        Some(f) if bic(&f) < bic(fitted) => f,
        _ => refine(dataset, fitted.clone(), build),
    }
}
