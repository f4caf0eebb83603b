//! One fit at a given structure: equation error, rank one, then the simulation error.

use super::basis::Basis;
use super::data::FOLDS;
use super::data::{Data, Featured};
use super::equation_error::Moments;
use super::problem::{Parameters, Segment, Structure};
use super::rank_one::{alternate, gauss_newton, nearest_rank_one, over_parameterised, residual_energy};
use super::runs::Runs;
use super::settings::InputMap;
use super::simulation_error::{Effort, Refinement, cost};
use switchback_model::linear::is_stable;

/// The data seen through every basis of a ladder from the straight line up to the map wanted.
///
/// The simulation error has local minima, and a start from the equation error alone may end in a poor one: worse than the
/// straight line that the curve contains. Climbing from each model to the next larger one that contains it rules that out.
#[derive(Debug)]
pub(super) struct Ladder<'a> {
    rungs: Vec<Featured<'a>>,
}

/// What a fit makes least.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FitKind {
    /// The equation error: consistent where that is white.
    Equation,
    /// The error of the free run: consistent for any stationary noise, efficient where the noise of the output is white.
    Simulation,
    /// The same error, filtered by an autoregressive model of the noise that is estimated apart: consistent for any stationary noise, and efficient.
    Prewhitened,
}

/// A fit, with the structure and the basis it is in.
#[derive(Debug, Clone)]
pub(super) struct Fitted {
    pub(super) structure: Structure,
    pub(super) basis: Basis,
    pub(super) theta: Parameters,
    /// Coefficients of the filter that makes its errors white; none where they are taken as they are.
    pub(super) whitening: Vec<f64>,
}

impl Fitted {
    /// The same system in a structure and on a basis that contain its own, or nearly so.
    pub(super) fn lifted(&self, structure: Structure, basis: &Basis) -> Parameters {
        self.theta.in_structure(self.structure, structure).on_basis(&self.basis, basis)
    }
}

/// Knots a curve in the coarse fits, and in the first stage of the selection: enough for a bend and a jump.
pub(super) const FIRST_KNOTS: usize = 5;

impl<'a> Ladder<'a> {
    /// The coarse fits up to `knots` knots a curve.
    pub(super) fn new(data: &Data<'a>, map: InputMap, knots: usize) -> Self {
        let on_the_path = knots.min(FIRST_KNOTS);
        let mut rungs = vec![(InputMap::Linear, 2)];
        if map != InputMap::Linear {
            rungs.push((InputMap::Static, on_the_path));
            rungs.push((map, on_the_path));
            rungs.push((map, knots));
            rungs.dedup();
        }
        Self { rungs: rungs.into_iter().map(|(map, k)| data.featured(data.basis(map, k))).collect() }
    }

    /// The rung of the map wanted.
    pub(super) fn top(&self) -> &Featured<'a> {
        &self.rungs[self.rungs.len() - 1]
    }

    /// Fits to the stretches that `choose` picks of each rung, one a structure; `None` where no stable model fits.
    ///
    /// A structure also starts from the smaller ones before it in the list that it contains, so that more
    /// coefficients never fit worse.
    pub(super) fn climb_all<'s>(
        &'s self,
        structures: &[Structure],
        effort: Effort,
        choose: impl Fn(&'s Featured<'a>, Structure) -> Vec<Segment<'s>>,
    ) -> Vec<Option<Fitted>> {
        let mut fits: Vec<Option<Fitted>> = Vec::with_capacity(structures.len());
        for &structure in structures {
            let smaller = fits.iter().flatten().filter(|f| f.structure.is_just_inside(structure));
            let smaller: Vec<Fitted> = smaller.cloned().collect();
            fits.push(self.climb(structure, effort, &smaller, |rung| choose(rung, structure)));
        }
        fits
    }

    /// The fit at the top, given fits to start from; `None` if no stable model fits.
    pub(super) fn climb<'s>(
        &'s self,
        structure: Structure,
        effort: Effort,
        smaller: &[Fitted],
        choose: impl Fn(&'s Featured<'a>) -> Vec<Segment<'s>>,
    ) -> Option<Fitted> {
        let mut below: Option<Fitted> = None;
        // A smaller structure at the top has climbed before.
        let from = if smaller.is_empty() { 0 } else { self.rungs.len() - 1 };
        for (i, rung) in self.rungs.iter().enumerate().skip(from) {
            let is_top = i + 1 == self.rungs.len();
            let segments = choose(rung);
            let starts = below.iter().chain(smaller.iter().filter(|_| is_top));
            let starts = starts.map(|f| f.lifted(structure, &rung.basis)).collect();
            let effort = if is_top { effort } else { Effort::SEARCH };
            let theta = refined(rung, structure, &segments, starts, effort)?;
            below = Some(Fitted { structure, basis: rung.basis.clone(), theta, whitening: Vec::new() });
        }
        below
    }

    /// The fit to the blocks of a search, by means of the smaller structures inside it.
    pub(super) fn climb_from_smaller(&self, structure: Structure) -> Option<Fitted> {
        let smaller = |delay: isize| (1..=structure.order).map(move |order| Structure { order, delay });
        let delays = structure.delay..=structure.delay.max(0);
        let path: Vec<Structure> = delays.rev().flat_map(smaller).collect();
        let fits = self.climb_all(&path, Effort::SEARCH, |rung, s| rung.search_blocks(s, FOLDS));
        fits.into_iter().flatten().find(|f| f.structure == structure)
    }

    /// The equation-error fit at the top, without refinement.
    pub(super) fn one_shot(&self, structure: Structure, segments: &[Segment]) -> Option<Fitted> {
        self.top().one_shot(structure, segments)
    }
}

impl Featured<'_> {
    /// The equation-error fit, without refinement.
    pub(super) fn one_shot(&self, structure: Structure, segments: &[Segment]) -> Option<Fitted> {
        let moments = Moments::of(structure, self.basis.features(), segments);
        let theta = equation_error_fit(&moments)?;
        Some(Fitted { structure, basis: self.basis.clone(), theta, whitening: Vec::new() })
    }

    /// The fit of least simulation error from a fit in the same structure on another basis.
    pub(super) fn lifted(&self, fitted: &Fitted, segments: &[Segment], effort: Effort) -> Option<Fitted> {
        let start = stabilised(fitted.lifted(fitted.structure, &self.basis));
        let curves: Vec<usize> = self.basis.sizes().collect();
        let theta = Refinement::new(effort, &curves).run(fitted.structure, start, segments);
        let is_finite = cost(fitted.structure, &theta, segments).is_finite();
        is_finite.then(|| Fitted {
            structure: fitted.structure,
            basis: self.basis.clone(),
            theta,
            whitening: Vec::new(),
        })
    }
}

/// The rank-one fit of least equation error: from the over-parameterised estimate where the records allow it,
/// and from alternation otherwise.
pub(super) fn equation_error_fit(moments: &Moments) -> Option<Parameters> {
    let starts = rank_one_start(moments)
        .into_iter()
        .chain(numerators(moments.structure).filter_map(|b| alternate(moments, b, 5)));
    let fits =
        starts.map(|start| gauss_newton(moments, start)).map(|fit| (residual_energy(moments, &fit), fit));
    fits.filter(|(energy, _)| energy.is_finite()).min_by(|x, y| x.0.total_cmp(&y.0)).map(|(_, fit)| fit)
}

/// The rank-one fit that the over-parameterised estimate leads to: the least one wherever the records excite every column well, at a fraction
/// of the cost of trying every start.
pub(super) fn quick_equation_error_fit(moments: &Moments) -> Option<Parameters> {
    match rank_one_start(moments) {
        Some(start) => Some(gauss_newton(moments, start)),
        None => equation_error_fit(moments),
    }
}

fn rank_one_start(moments: &Moments) -> Option<Parameters> {
    over_parameterised(moments).and_then(|x| nearest_rank_one(moments, &x))
}

/// Numerators to start an alternation from: a mean, a pure delay, and nearly a difference.
fn numerators(structure: Structure) -> impl Iterator<Item = Vec<f64>> {
    let nb = structure.numerator();
    let mut delay = vec![0.0; nb];
    delay[0] = 1.0;
    let mut difference = delay.clone();
    if nb > 1 {
        difference[1] = -0.95;
    }
    [vec![1.0 / nb as f64; nb], delay, difference].into_iter()
}

/// Fits of the equation error, best in simulation first: the alternation may end in different places from different
/// numerators.
fn equation_error_starts(featured: &Featured, structure: Structure, segments: &[Segment]) -> Vec<Parameters> {
    let moments = Moments::of(structure, featured.basis.features(), segments);
    let fits = numerators(structure).filter_map(|b| alternate(&moments, b, 10)).map(stabilised).collect();
    ranked(structure, fits, segments)
}

/// The best of the starts after a few steps, refined as far as `effort` says.
fn refined(
    featured: &Featured,
    structure: Structure,
    segments: &[Segment],
    lifted: Vec<Parameters>,
    effort: Effort,
) -> Option<Parameters> {
    let curves: Vec<usize> = featured.basis.sizes().collect();
    let refinement = |effort| Refinement::new(effort, &curves);
    let trial = refinement(Effort::TRIAL);
    let lifted = ranked(structure, lifted.into_iter().map(stabilised).collect(), segments);
    let fresh = equation_error_starts(featured, structure, segments);
    let starts = lifted.into_iter().take(2).chain(fresh.into_iter().take(1));
    let starts = starts.map(|s| trial.run(structure, s, segments)).collect();
    let start = ranked(structure, starts, segments).into_iter().next()?;
    Some(refinement(effort).run(structure, start, segments))
}

/// The next fit on a finer grid that contains its own, from where it was.
pub(super) fn refitted(
    finer: &Featured,
    segments: &[Segment],
    fitted: &Fitted,
    kind: FitKind,
) -> Option<Fitted> {
    let (structure, basis) = (fitted.structure, finer.basis.clone());
    if kind == FitKind::Equation {
        let theta = equation_error_fit(&Moments::of(structure, basis.features(), segments))?;
        return Some(Fitted { structure, basis, theta, whitening: Vec::new() });
    }
    Some(simulated(
        &Runs::new(segments.to_vec()),
        fitted.lifted(structure, &basis),
        (structure, basis),
        &fitted.whitening,
        kind,
    ))
}

/// The fit of least simulation error from a start, with a filter to begin with.
pub(super) fn simulated(
    runs: &Runs,
    start: Parameters,
    (structure, basis): (Structure, Basis),
    whitening: &[f64],
    kind: FitKind,
) -> Fitted {
    let theta = runs.refined(structure, &basis, stabilised(start), whitening, Effort::FINAL);
    let (theta, whitening) = match kind {
        FitKind::Prewhitened => runs.prewhitened(structure, &basis, theta, whitening.to_vec()),
        FitKind::Equation | FitKind::Simulation => (theta, Vec::new()),
    };
    Fitted { structure, basis, theta, whitening }
}

/// By simulation error, least first; unstable ones are dropped.
fn ranked(structure: Structure, fits: Vec<Parameters>, segments: &[Segment]) -> Vec<Parameters> {
    let costed = fits.into_iter().map(|s| (cost(structure, &s, segments), s));
    let mut costed: Vec<_> = costed.filter(|(c, _)| c.is_finite()).collect();
    costed.sort_by(|x, y| x.0.total_cmp(&y.0));
    costed.into_iter().map(|(_, s)| s).collect()
}

/// The same numerator with the poles drawn towards zero until they are stable.
pub(super) fn stabilised(mut theta: Parameters) -> Parameters {
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
