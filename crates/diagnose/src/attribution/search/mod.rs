//! The search for an effect's nonlinear parameters: a cheap screening of every start of every law, then the best ones to convergence.

mod candidate_laws;
mod drift_path;
mod knots;
mod profile;
mod question;
mod reidentification;
mod screening;

use self::candidate_laws::CandidateLaw;
pub(crate) use self::drift_path::on_a_free_drift_path;
pub(crate) use self::profile::profiled;
pub(crate) use self::question::Question;
pub(crate) use self::reidentification::reidentified;
pub(crate) use self::screening::screened;
use crate::attribution::explain::{Hypothesis, assembled};
use crate::attribution::starts::Known;
use crate::effects::Search;
use crate::likelihood::design::{Design, Linear, Whitener};
use crate::likelihood::engine::{Build, Fit, FitContext, NonlinearParameter, fit};
use crate::model::augmented::AugmentedModel;
use crate::nominal::dynamics::dynamics_refitted;
use crate::records::dataset::Dataset;

/// Gauss–Newton rounds of the screening, of the final fit, and before it is known which laws may win.
const SCREENING: usize = 2;
/// Starts of a screened law that go on after the first round.
const AHEAD: usize = 2;
const FINAL: usize = 14;
const RACE: usize = 4;
/// Rounds in which `A` and a noise filter that follows from it are solved for in turn (Steiglitz and McBride, 1965).
const RELAXED: usize = 6;
/// Points of a pattern search at most: to see whether a law may still win, and in the end.
const SCOUTED: usize = 8;
const TRIALS: usize = 30;

/// A sketch some rounds on: enough to see whether it may still win.
pub(crate) fn advance(dataset: &Dataset, fixed: usize, sketch: &Hypothesis) -> Hypothesis {
    improved(dataset, fixed, sketch, |task, fit| match sketch.has_corners() {
        true => task.pattern(fit, sketch.only_weighs(), SCOUTED, RACE),
        false => task.together(&fit.nonlinear, &fit.linear, RACE).unwrap_or(fit),
    })
}

/// A sketch fitted to convergence, which need not be [sound](Hypothesis::is_sound); where the likelihood has corners, the first
/// `fixed` nonlinear parameters stay as they are.
pub(crate) fn finish(dataset: &Dataset, fixed: usize, sketch: &Hypothesis) -> Hypothesis {
    improved(dataset, fixed, sketch, |task, fit| match sketch.has_corners() {
        true => task.pattern(fit, sketch.only_weighs(), TRIALS, FINAL),
        false => task.settled(fit),
    })
}

/// A candidate fitted to convergence beside a nominal model whose own parameters stay as they are.
pub(crate) fn beside_the_model(dataset: &Dataset, nominal: &Hypothesis, single: &Hypothesis) -> Hypothesis {
    let known = &nominal.fit;
    let start = Fit { linear: known.linear.clone(), grid: known.grid.clone(), ..single.fit.clone() };
    let fixed = dataset.with_nominal_fixed(&known.grid);
    let found = finish(&fixed, 0, &Hypothesis { fit: start, ..single.clone() });
    let parameters = known.parameters + found.fit.parameters;
    Hypothesis { fit: Fit { parameters, ..found.fit }, set_back: nominal.set_back, ..found }
}

fn improved(
    dataset: &Dataset,
    fixed: usize,
    sketch: &Hypothesis,
    improve: impl Fn(&Task<'_>, Fit) -> Fit,
) -> Hypothesis {
    let build = |values: &[f64]| assembled(&sketch.effect_terms, values);
    let grid = sketch.fit.grid.clone();
    let task = Task {
        context: FitContext { dataset, grid: &grid, known: Some(sketch.fit.near()) },
        build: &build,
        fixed,
    };
    let fit = improve(&task, sketch.fit.clone()).set_aside(sketch.fit.near());
    Hypothesis { fit, ..sketch.clone() }
}

/// A cheap screening of a law on top of what is known: near its best start.
fn screen(known: &Known<'_>, candidate: &CandidateLaw) -> Option<Hypothesis> {
    let (dataset, design, known) = (known.dataset, &known.design, known.hypothesis);
    let (law, effect_terms) = (&candidate.law, &candidate.effect_terms);
    let grid = law.grid.as_ref().unwrap_or(&known.fit.grid);
    let build = |values: &[f64]| assembled(effect_terms, values);
    let base = match &law.grid {
        Some(grid) => crate::nominal::knots::carried_over(&known.fit, grid),
        None => known.fit.linear.clone(),
    };
    let context = FitContext { dataset, grid, known: Some(&**design) };
    let task = Task { context, build: &build, fixed: known.fit.nonlinear.len() };
    // The nonlinear parameters of what is known, then those of the law.
    let joined = |nonlinear: &[NonlinearParameter]| {
        known.fit.nonlinear.iter().chain(nonlinear).copied().collect::<Vec<NonlinearParameter>>()
    };
    let starts = law.starts.iter().map(|nonlinear| joined(nonlinear));
    let fixed = |nonlinear: Vec<NonlinearParameter>| {
        let here = Design::like(context.known, dataset, grid, &task.augmented(&nonlinear));
        let there = task.on(&here);
        let afresh = there.dynamics_refitted(&nonlinear, &base).and_then(|p| there.fixed(&nonlinear, &p, 0));
        let nearer = best([there.fixed(&nonlinear, &base, 0), afresh].into_iter().flatten())?;
        there.fixed(&nonlinear, &nearer.linear, 1).map(|fit| fit.set_aside(design))
    };
    let started = |nonlinear: Vec<NonlinearParameter>| {
        task.together(&nonlinear, &base, 1).map(|fit| fit.set_aside(design))
    };
    let fit = match law.search {
        // Without nonlinear parameters there is one start, and nothing to compare.
        Search::Smooth if law.starts[0].is_empty() => task.together(&known.fit.nonlinear, &base, FINAL),
        Search::Smooth => ahead(starts.filter_map(started), |fit| {
            task.from(fit).together(&fit.nonlinear, &fit.linear, SCREENING - 1)
        }),
        Search::Profile => ahead(starts.filter_map(fixed), |fit| {
            task.from(fit).fixed(&fit.nonlinear, &fit.linear, SCREENING - 1)
        }),
        Search::Weights => best(starts.filter_map(|nonlinear| task.fixed(&nonlinear, &base, 0)))
            .and_then(|best| task.fixed(&best.nonlinear, &best.linear, SCREENING)),
        Search::Conditional => {
            let mut fixed: Vec<Fit> = starts.filter_map(fixed).collect();
            fixed.sort_by(|x, y| x.deviance.total_cmp(&y.deviance));
            // The best start need not lead to the best point: B may have taken what a neighbour would explain.
            best(
                fixed
                    .iter()
                    .take(law.climbs)
                    .filter_map(|h| task.together(&h.nonlinear, &h.linear, SCREENING)),
            )
        }
    }?;
    let (fit, set_back) = (fit.set_aside(known.fit.near()), known.set_back);
    Some(Hypothesis { effect_terms: effect_terms.clone(), fit, set_back, held_out: 0.0 })
}

/// One law's search.
struct Task<'a> {
    context: FitContext<'a>,
    build: &'a Build<'a>,
    /// Nonlinear parameters that belong to effects already known.
    fixed: usize,
}

impl Task<'_> {
    /// The search from where a fit ended.
    fn from<'b>(&'b self, fit: &'b Fit) -> Task<'b> {
        self.on(fit.near())
    }

    /// The search where something is built already: it serves on.
    fn on<'b>(&'b self, design: &'b Design) -> Task<'b> {
        let context = FitContext { known: Some(design), ..self.context };
        Task { context, build: self.build, fixed: self.fixed }
    }

    fn augmented(&self, nonlinear: &[NonlinearParameter]) -> AugmentedModel {
        (self.build)(&nonlinear.iter().map(|o| o.value).collect::<Vec<_>>())
    }

    /// Everything fitted together.
    fn together(&self, nonlinear: &[NonlinearParameter], start: &Linear, rounds: usize) -> Option<Fit> {
        let start = self.padded(start, &self.augmented(nonlinear));
        fit(self.context, self.build, nonlinear, &start, rounds)
    }

    /// The fit with the nonlinear parameters held, which is a nearly linear problem.
    fn fixed(&self, nonlinear: &[NonlinearParameter], start: &Linear, rounds: usize) -> Option<Fit> {
        let augmented = self.augmented(nonlinear);
        let start = self.padded(start, &augmented);
        let mut fitted = fit(self.context, &|_| augmented.clone(), &[], &start, rounds)?;
        fitted.nonlinear = nonlinear.to_vec();
        fitted.nonlinear_se = vec![f64::NAN; nonlinear.len()];
        fitted.parameters += nonlinear.len() as f64;
        Some(fitted)
    }

    /// `A` and `B` by least squares; nothing without a filter. Where the filter of the noise follows from `A`, by some rounds.
    fn dynamics_refitted(&self, nonlinear: &[NonlinearParameter], start: &Linear) -> Option<Linear> {
        if self.context.dataset.holds_nominal() {
            return None;
        }
        let augmented = self.augmented(nonlinear);
        let noise = &augmented.noise;
        let coloured = !noise.ar.is_empty() || !noise.ma.is_empty();
        if augmented.denominator.len() < 2 && augmented.delay == 0.0 && !coloured && noise.output_ratio == 0.0
        {
            return None;
        }
        let rounds = if noise.output_ratio > 0.0 { RELAXED } else { 1 };
        let design = Design::like(self.context.known, self.context.dataset, self.context.grid, &augmented);
        (0..rounds).try_fold(self.padded(start, &augmented), |p, _| {
            dynamics_refitted(&design, &Whitener::new(noise, &p.a), &p)
        })
    }

    /// Alternates between everything together and the nonlinear parameters held, until neither moves: where nonlinear parameters
    /// and dynamics trade against each other, a joint step may stall far from the best point.
    fn settled(&self, sketch: Fit) -> Fit {
        let Some(mut top) = self.together(&sketch.nonlinear, &sketch.linear, FINAL) else { return sketch };
        for _ in 0..3 {
            let next = (self.from(&top))
                .fixed(&top.nonlinear, &top.linear, 4)
                .filter(|fixed| fixed.deviance < top.deviance - 1.0)
                .and_then(|fixed| self.from(&fixed).together(&fixed.nonlinear, &fixed.linear, FINAL));
            match next {
                Some(next) if next.deviance < top.deviance - 1.0 => top = next,
                _ => break,
            }
        }
        top
    }

    /// A pattern search over nonlinear parameters whose likelihood has corners; steps start at each parameter's `step`.
    /// Where they only weigh the samples, the rest need not follow at every step.
    fn pattern(&self, sketch: Fit, only_weighs: bool, trials: usize, rounds: usize) -> Fit {
        let follows = if only_weighs { 0 } else { 2 };
        let mut top = sketch;
        let mut share = 1.0;
        let mut left = trials;
        while share > 0.02 && left > 0 {
            let mut improved = false;
            for j in self.fixed..top.nonlinear.len() {
                for direction in [-1.0, 1.0] {
                    let mut nonlinear = top.nonlinear.clone();
                    let o = &mut nonlinear[j];
                    o.value = (o.value + direction * share * o.step).clamp(o.low, o.high);
                    left = left.saturating_sub(1);
                    if let Some(f) = self.fixed(&nonlinear, &top.linear, follows)
                        && f.deviance < top.deviance
                    {
                        top = f;
                        improved = true;
                        break;
                    }
                }
            }
            if !improved {
                share *= 0.4;
            }
        }
        self.fixed(&top.nonlinear, &top.linear, rounds).filter(|f| f.deviance <= top.deviance).unwrap_or(top)
    }

    fn padded(&self, start: &Linear, augmented: &AugmentedModel) -> Linear {
        start.padded(self.context.grid.len(), augmented)
    }
}

/// The best of several fits after some rounds more for those that lead.
fn ahead(fits: impl Iterator<Item = Fit>, further: impl Fn(&Fit) -> Option<Fit>) -> Option<Fit> {
    let mut field: Vec<Fit> = fits.collect();
    field.sort_by(|x, y| x.deviance.total_cmp(&y.deviance));
    best(field.iter().take(AHEAD).filter_map(further))
}

fn best(fits: impl Iterator<Item = Fit>) -> Option<Fit> {
    fits.min_by(|x, y| x.deviance.total_cmp(&y.deviance))
}

#[cfg(test)]
mod tests;
