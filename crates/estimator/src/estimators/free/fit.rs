//! One fit at a given structure: equation error, rank one, then the simulation error.

use super::data::Featured;
use super::equation_error::Moments;
use super::problem::{Parameters, Segment, Structure};
use super::rank_one::alternate;
use super::simulation_error::{Refinement, cost, is_stable};

/// How hard a fit tries.
#[derive(Debug, Clone, Copy)]
pub(super) struct Effort {
    pub(super) iterations: usize,
    pub(super) tolerance: f64,
}

impl Effort {
    /// Enough to rank structures.
    pub(super) const SEARCH: Self = Self { iterations: 12, tolerance: 1e-3 };
    /// For the fit that is kept.
    pub(super) const FINAL: Self = Self { iterations: 200, tolerance: 1e-9 };
}

/// Weight of the smoothness penalty: decides only what the data leave open.
const SMOOTHNESS: f64 = 1e-8;

/// The fit to some stretches of data; `None` if none of the starts leads to a stable model.
pub(super) fn fit(
    featured: &Featured,
    structure: Structure,
    segments: &[Segment],
    effort: Option<Effort>,
) -> Option<Parameters> {
    let moments = Moments::of(structure, featured.basis.features(), segments);
    let nb = structure.numerator();
    let uniform = vec![1.0 / nb as f64; nb];
    let mut first = vec![0.0; nb];
    first[0] = 1.0;
    let mut difference = first.clone();
    if nb > 1 {
        difference[1] = -0.95;
    }
    let mut starts: Vec<Parameters> = [uniform, first, difference]
        .into_iter()
        .filter_map(|b| alternate(&moments, b, 10))
        .map(|theta| stabilised(theta))
        .collect();
    let Some(effort) = effort else {
        return best(structure, starts, segments);
    };
    let curves: Vec<usize> = featured.basis.sizes().collect();
    let refinement = Refinement { iterations: 4, tolerance: 1e-3, curves: &curves, smoothness: SMOOTHNESS };
    starts = starts.into_iter().map(|s| refinement.run(structure, s, segments)).collect();
    let start = best(structure, starts, segments)?;
    let refinement = Refinement { iterations: effort.iterations, tolerance: effort.tolerance, ..refinement };
    Some(refinement.run(structure, start, segments))
}

/// The start of least simulation error.
fn best(structure: Structure, starts: Vec<Parameters>, segments: &[Segment]) -> Option<Parameters> {
    let costed = starts.into_iter().map(|s| (cost(structure, &s, segments), s));
    costed.filter(|(c, _)| c.is_finite()).min_by(|x, y| x.0.total_cmp(&y.0)).map(|(_, s)| s)
}

/// The same numerator with the poles drawn towards zero until they are stable.
fn stabilised(mut theta: Parameters) -> Parameters {
    for _ in 0..200 {
        if is_stable(&theta.a) {
            break;
        }
        let mut shrink = 1.0;
        for a in &mut theta.a {
            shrink *= 0.97;
            *a *= shrink;
        }
    }
    theta
}
