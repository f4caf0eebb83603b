//! Knots that earn less than they cost.

use super::first::first_grid;
use super::model::Model;
use crate::likelihood::design::Design;
use crate::likelihood::engine::{Fit, priors};
use crate::likelihood::jacobian::normal_equations;
use crate::likelihood::weights::Weights;

/// Gain in deviance below which an added knot is taken out again.
const WORTH: f64 = 16.0;

/// Without the knots and jumps that earn less than they cost.
pub(super) fn pruned(model: &Model<'_>, best: Fit) -> Fit {
    let dataset = model.dataset;
    let first = first_grid(dataset);
    let design = Design::like(Some(best.near()), dataset, &best.grid, &best.augmented);
    let whitener = design.whitener(&best.augmented.noise, &best.linear.a);
    let innovations = design.counted_innovations(&best.linear, &whitener);
    let mut normal =
        normal_equations(&design, &best.linear, &whitener, &Weights::default(), (&innovations.concat(), &[]));
    // Without the gauge no border value would be determined.
    priors(&mut normal, &best.grid, &best.linear, &best.augmented);
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
    match model.refitted(&best, &grid) {
        Some(f) if cost(&f) < cost(&best) => f,
        _ => best,
    }
}
